"""Focus stacks that share no code with vkfv: texture through the scalar pupil, and noise of cameras and rays.

The image is linear in the texture's light. Its transfer at the spatial frequency f and the defocus z is the autocorrelation of
the pupil exp(i k z (sqrt(1 - NA^2 rho^2) - 1)), exact in the angle, of even weight over rho, which keeps a Lambertian surface's
radiance. A pixel integrates over its area. Images are periodic, so that every point of them is like every other.

Needs numpy.
"""
import functools
import math

import numpy

WAVELENGTH_UM = 0.55


def nyquist_pitch_um(aperture):
    """The largest pixels that the cutoff frequency 2 NA / wavelength allows."""
    return WAVELENGTH_UM / (4 * aperture)


@functools.lru_cache(maxsize=None)
def _transfer_table(aperture, z_um, spherical_waves=0.0, samples=64, frequencies=101):
    """Transfer function by separation of the pupils, 0 to 2 radii: the sum over the overlap of two displaced pupils, of which
    one quarter is computed, since all four are equal. spherical_waves: Zernike's primary spherical aberration, 6 rho^4 - 6 rho^2 + 1, in waves."""
    u = (numpy.arange(samples) + 0.5) / samples
    y = u[:, None]
    result = numpy.empty(frequencies)
    k = 2 * math.pi / WAVELENGTH_UM

    def phase(square):
        depth = numpy.sqrt(numpy.maximum(0.0, 1 - aperture**2 * square))
        return k * z_um * (depth - 1) + 2 * math.pi * spherical_waves * (6 * square**2 - 6 * square + 1)

    for index, separation in enumerate(numpy.linspace(0, 2, frequencies)):
        half = separation / 2
        # The lens of overlap is stretched to the square, so that its edge is exact.
        width = 1 - half
        x = width * u[None, :]
        height = numpy.sqrt(numpy.maximum(0.0, 1 - (x + half) ** 2))
        yy = height * y
        difference = phase((x + half) ** 2 + yy**2) - phase((x - half) ** 2 + yy**2)
        result[index] = (height * numpy.cos(difference)).mean() * width * 4
    return result / math.pi


class Optics:
    """Transfer of an aperture at this pitch, on a periodic grid of side x side pixels."""

    def __init__(self, side, aperture, pitch_um, spherical_waves=0.0):
        f = numpy.fft.fftfreq(side, pitch_um)
        fx, fy = f[None, :side // 2 + 1].copy(), f[:, None]
        fx = numpy.abs(fx)
        self.side = side
        self.aperture = aperture
        self.spherical_waves = spherical_waves
        self.separation = numpy.hypot(fx, fy) * WAVELENGTH_UM / aperture  # 2 at the cutoff
        self.pixel = numpy.sinc(fx * pitch_um) * numpy.sinc(fy * pitch_um)

    def transfer(self, z_um):
        table = _transfer_table(self.aperture, round(abs(z_um) if self.spherical_waves == 0 else z_um, 6), self.spherical_waves)
        return numpy.interp(self.separation, numpy.linspace(0, 2, len(table)), table, right=0.0)

    def through(self, field, transfer):
        return numpy.fft.irfft2(numpy.fft.rfft2(field) * transfer, s=(self.side, self.side))


def texture(optics, random, contrast, correlation_px=0.0):
    """White light of this standard deviation over the mean in the image in focus. correlation_px: of a Gaussian that
    the texture is blurred with besides, its standard deviation."""
    white = random.normal(size=(optics.side, optics.side))
    f = numpy.fft.fftfreq(optics.side)
    coarse = numpy.exp(-2 * (math.pi * correlation_px) ** 2 * (f[:, None] ** 2 + numpy.abs(f[None, :optics.side // 2 + 1]) ** 2))
    white = optics.through(white, coarse)
    return white * contrast / optics.through(white, optics.transfer(0.0) * optics.pixel).std()


def flat_stack(optics, light, z_um):
    """The mean brightness is 1. light: texture about 0, in focus at 0."""
    spectrum = numpy.fft.rfft2(light)
    return [1 + numpy.fft.irfft2(spectrum * optics.transfer(z) * optics.pixel, s=light.shape) for z in z_um]


def relief_stack(optics, light, height_um, z_um, layer_um=0.2):
    """The same of a surface of this height at every pixel. Every pixel's light is shared by the two layers next to it, which are
    layer_um apart: much less than the depth of focus. What neighbours shadow is left out."""
    place = height_um / layer_um
    below = numpy.floor(place).astype(int)
    images = [numpy.zeros(optics.separation.shape, complex) for _ in z_um]
    for layer in range(below.min(), below.max() + 2):
        share = numpy.maximum(0.0, 1 - numpy.abs(place - layer))
        if not share.any():
            continue
        spectrum = numpy.fft.rfft2(light * share)
        for image, z in zip(images, z_um):
            image += spectrum * optics.transfer(z - layer * layer_um)
    return [1 + numpy.fft.irfft2(image * optics.pixel, s=light.shape) for image in images]


def camera_noise(image, random, electrons, read_e=5.0):
    """Photons and the reading of a camera, of an image about 1."""
    photons = random.poisson(numpy.maximum(image, 0) * electrons) + random.normal(scale=read_e, size=image.shape)
    return photons / electrons


def ray_noise(image, random, rays):
    """Rays counted by each pixel for itself, without waves."""
    return random.poisson(numpy.maximum(image, 0) * rays) / rays


def blurred_ray_noise(image, random, rays, optics):
    """Rays that every part of the pupil blurs for itself: white noise of so many rays a pixel, whose power passes as the
    overlap of the pupils in focus (waves)."""
    white = random.normal(scale=1 / math.sqrt(rays), size=image.shape)
    return image + optics.through(white, numpy.sqrt(numpy.maximum(0.0, optics.transfer(0.0))) * optics.pixel)
