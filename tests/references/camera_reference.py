#!/usr/bin/env python3
"""An independent check of vkfv's camera: numpy's own generators and EMVA 1288's equations written down again.

    tests/references/camera_reference.py FOLDER

FOLDER is what `vkfv camera C.toml --images --out FOLDER` wrote. Its images are evaluated here, by the equations of EMVA
Standard 1288 (release 4.0 linear), and held against camera.json, which vkfv's own evaluation wrote; and the same images are
simulated by numpy (Philox is not used: PCG64, its own Poisson and normal numbers) from the values put in, and evaluated
likewise. Both must agree within five standard errors. Needs numpy and tifffile.
"""
import csv
import json
import pathlib
import sys

import numpy
import tifffile


def read_series(folder):
    """Images by series: lists of (photons, exposure time, image)."""
    series = {}
    with open(folder / "images.csv", encoding="utf-8") as rows:
        for row in csv.DictReader(rows):
            image = tifffile.imread(folder / row["file"]).astype(float)
            series.setdefault(row["series"], []).append((float(row["photons"]), float(row["exposure_s"]), image))
    return series


def pairs(images):
    """Photons, mean and temporal variance of each pair, as section 6.5 has them."""
    result = []
    for (photons, _, one), (_, _, other) in zip(images[::2], images[1::2]):
        difference = one - other
        variance = (difference**2).mean() / 2 - (one.mean() - other.mean()) ** 2 / 2
        result.append((photons, (one.mean() + other.mean()) / 2, variance))
    return numpy.array(result).T


def nonuniformity(images):
    """Mean and spatial variance of a stack, what averaging leaves of temporal noise taken off."""
    stack = numpy.array([image for _, _, image in images])
    return stack.mean(), stack.mean(0).var() - stack.var(0, ddof=1).mean() / len(stack)


def evaluate(series):
    photons, mean, variance = pairs(series["transfer"])
    peak_photons, _, peak_variance = pairs(series["peak"])
    middle, reach = peak_photons.mean(), numpy.ptp(peak_photons) / 2
    cubic = numpy.polynomial.Polynomial.fit((peak_photons - middle) / reach, peak_variance, 3, domain=[-1, 1])
    fine = numpy.linspace(-1, 1, 20001)
    saturation = middle + reach * fine[cubic(fine).argmax()]
    linear = (photons > 0) & (photons <= 0.7 * saturation)
    signal, noise = mean[linear] - mean[0], variance[linear] - variance[0]
    weight = variance[linear] ** -2.0
    gain = (weight * signal * noise).sum() / (weight * signal**2).sum()
    weight = 1 / variance[linear]
    responsivity = (weight * signal * photons[linear]).sum() / (weight * photons[linear] ** 2).sum()
    efficiency = responsivity / gain
    threshold = (numpy.sqrt(variance[0]) / gain + 0.5) / efficiency
    dark_mean, dark = nonuniformity(series["dark stack"])
    flat_mean, flat = nonuniformity(series["flat stack"])
    return {
        "gain_dn_per_e": gain,
        "quantum_efficiency_percent": 100 * efficiency,
        "read_noise_e": numpy.sqrt(variance[0] - 1 / 12) / gain,
        "saturation_capacity_e": efficiency * saturation,
        "largest_signal_to_noise_db": 10 * numpy.log10(efficiency * saturation),
        "dynamic_range_db": 20 * numpy.log10(saturation / threshold),
        "sensitivity_threshold_photons": threshold,
        "dsnu_e": numpy.sqrt(dark) / gain,
        "prnu_percent": 100 * numpy.sqrt(flat - dark) / (flat_mean - dark_mean),
    }


def simulate(series, figures, offset):
    """The same images by numpy, of the values put in."""
    random = numpy.random.Generator(numpy.random.PCG64(20241288))
    put_in = {name: figure["put_in"] for name, figure in figures.items() if isinstance(figure, dict)}
    shape = series["transfer"][0][2].shape
    response = 1 + put_in["prnu_percent"] / 100 * random.standard_normal(shape)
    dark_signal = put_in["dsnu_e"] * random.standard_normal(shape)
    dark_current = put_in.get("dark_current_e_per_s", 0)
    highest = 2 ** figures["bit_depth"] - 1

    def image(photons, seconds):
        light = photons * put_in["quantum_efficiency_percent"] / 100 * response
        charge = numpy.minimum(random.poisson(light + dark_current * seconds), figures["clip_e"])
        read = charge + dark_signal + put_in["read_noise_e"] * random.standard_normal(shape)
        return numpy.clip(numpy.floor(put_in["gain_dn_per_e"] * read + offset + 0.5), 0, highest)

    return {
        name: [(photons, seconds, image(photons, seconds)) for photons, seconds, _ in images]
        for name, images in series.items()
    }


def main():
    folder = pathlib.Path(sys.argv[1])
    figures = json.loads((folder / "camera.json").read_text(encoding="utf-8"))
    series = read_series(folder)
    from_images = evaluate(series)
    simulated = evaluate(simulate(series, figures, figures["offset_dn"]))
    agree = True
    print(f"{'':32} {'put in':>12} {'vkfv':>12} {'numpy, its':>12} {'numpy, own':>12} {'std error':>10}")
    print(f"{'':32} {'':>12} {'':>12} {'images':>12} {'images':>12}")
    for name, value in from_images.items():
        figure = figures[name]
        error = figure["standard_error"]
        same = abs(value / figure["measured"] - 1) < 1e-4  # the same images: the peak alone is found on a grid
        alike = abs(simulated[name] - figure["measured"]) < 5 * numpy.sqrt(2) * error
        agree = agree and same and alike
        print(
            f"{name:32} {figure['put_in']:12.6g} {figure['measured']:12.6g} {value:12.6g} {simulated[name]:12.6g} "
            f"{error:10.2g}{'' if same and alike else '  differs'}"
        )
    sys.exit(0 if agree else 1)


if __name__ == "__main__":
    main()
