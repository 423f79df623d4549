# vkfv by its Debian package, with a Vulkan driver for the processor (Mesa's lavapipe):
#   docker build --tag vkfv --build-arg VKFV_COMMIT=$(git rev-parse --short=12 HEAD) .
#   docker run --rm --volume "$PWD:/data" vkfv stack assets/stacks/demo.toml --out demo
# On a GPU: docker run --gpus all --env NVIDIA_DRIVER_CAPABILITIES=all ...
FROM debian:12 AS build
ARG VKFV_COMMIT=unknown
COPY . /vkfv
RUN /vkfv/tools/package

FROM debian:12
COPY --from=build /vkfv/build/package/vkfv_*.deb /vkfv.deb
RUN apt-get update && apt-get install --yes /vkfv.deb && rm -rf /vkfv.deb /var/lib/apt/lists/*
WORKDIR /data
ENTRYPOINT ["vkfv"]
