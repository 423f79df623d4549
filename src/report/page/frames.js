"use strict";
// The images of the stack, one at a time.
vkfv.parts.push(() => {
    const {frames} = vkfv.data;
    const {number} = vkfv;
    const slider = document.getElementById("frame-slider");
    const button = document.getElementById("play");
    if (!frames.z.length) {
        document.querySelector("#focus .focus").firstElementChild.hidden = true;
        return;
    }
    const images = vkfv.text("frames").split("\n");
    const picture = document.getElementById("frame-image");
    slider.max = frames.z.length - 1;
    const note = (frames.block > 1 ? `, means over ${frames.block} × ${frames.block} pixels` : "") +
                 (frames.every > 1 ? `, every ${frames.every}th image` : "");

    vkfv.events.on("frame.picture", () => {
        const k = vkfv.chosen.frame;
        slider.value = k;
        picture.src = `data:image/png;base64,${images[k]}`;
        const z = `${number(frames.z[k])} µm`;
        picture.alt = `Image of the stack at z = ${z}`;
        slider.setAttribute("aria-valuetext", `z = ${z}`);
        d3.select("#frame-text").text(`z = ${z}, image ${k * frames.every + 1}; white is ${vkfv.figure(frames.white)} ${frames.unit}${note}`);
    });
    slider.addEventListener("input", () => vkfv.choose("frame", Number(slider.value)));

    let playing = null;
    button.addEventListener("click", () => {
        playing = playing === null
            ? d3.interval(() => vkfv.choose("frame", (vkfv.chosen.frame + 1) % frames.z.length), 100) : (playing.stop(), null);
        button.textContent = playing === null ? "Play" : "Stop";
        button.setAttribute("aria-pressed", String(playing !== null));
    });

    // A pixel of a frame is a block of the image's pixels, as a point of a map is. Frame and map both begin at the
    // image's lower left.
    const cross = d3.select("#frame-cross").attr("viewBox", `0 0 ${frames.columns} ${frames.rows}`).attr("preserveAspectRatio", "none");
    const pixels = () => vkfv.chosen.evaluation.pixels;
    vkfv.events.on("cursor.frame", () => {
        const {x, y} = vkfv.chosen.cursor;
        const {x0, y0, pitch} = pixels();
        const across = ((x - x0) / pitch[0] + 0.5) / frames.block, up = frames.rows - ((y - y0) / pitch[1] + 0.5) / frames.block;
        const arm = frames.columns / 40;
        const path = `M${across - arm} ${up}h${2 * arm}M${across} ${up - arm}v${2 * arm}`;
        cross.selectAll("path").data(["halo", "cross"]).join("path").attr("class", d => d)
            .attr("vector-effect", "non-scaling-stroke").attr("d", path).style("stroke", d => d === "cross" ? "#c2185b" : null);
    });
    cross.node().addEventListener("pointermove", event => {
        const box = cross.node().getBoundingClientRect();
        const {x0, y0, pitch} = pixels();
        const map = vkfv.chosen.evaluation.map;
        const column = (event.clientX - box.left) / box.width * frames.columns * frames.block - 0.5;
        const row = (box.bottom - event.clientY) / box.height * frames.rows * frames.block - 0.5;
        const at = (value, origin, step, count) => Math.max(0, Math.min(count - 1, Math.round((value - origin) / step)));
        vkfv.choose("cursor", vkfv.mapPoint(at(x0 + column * pitch[0], map.x0, map.pitch[0], map.columns),
                                            at(y0 + row * pitch[1], map.y0, map.pitch[1], map.rows)));
    });
    vkfv.choose("frame", Math.floor(frames.z.length / 2));
});
