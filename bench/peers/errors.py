# SPDX-License-Identifier: Apache-2.0
"""Relative RMSE between lightmaps, as `aglow compare` defines it, and what follows from it."""
import math

import exr


class Map:
    """Three planes of irradiance in lux."""

    def __init__(self, width, height, planes):
        self.width, self.height, self.planes = width, height, planes

    @classmethod
    def read(cls, path):
        return cls(*exr.read_rgb(path))

    def lit(self):
        """Indices of the pixels that are not black."""
        r, g, b = self.planes
        return [i for i in range(len(r)) if r[i] or g[i] or b[i]]


def rms_difference(a, b, pixels):
    total = sum((x[i] - y[i]) ** 2 for x, y in zip(a.planes, b.planes) for i in pixels)
    return math.sqrt(total / (3 * len(pixels)))


def rms(a, pixels):
    return math.sqrt(sum(x[i] ** 2 for x in a.planes for i in pixels) / (3 * len(pixels)))


def mean(a, pixels):
    return sum(x[i] for x in a.planes for i in pixels) / (3 * len(pixels))


class Reference:
    """The mean of two independent converged maps; their difference tells its own noise."""

    def __init__(self, first, second, pixels):
        self.pixels = pixels
        self.map = Map(first.width, first.height,
                       [[(x + y) / 2 for x, y in zip(p, q)]
                        for p, q in zip(first.planes, second.planes)])
        self.rms = rms(self.map, pixels)
        # Var(mean) = Var(difference) / 4.
        self.noise = rms_difference(first, second, pixels) / 2 / self.rms

    def error_of(self, candidate):
        """Relative RMSE of `candidate`, the reference's own noise taken out."""
        found = rms_difference(candidate, self.map, self.pixels) / self.rms
        return math.sqrt(max(0, found ** 2 - self.noise ** 2))


def seconds_to(error, runs):
    """Time at which the runs [(seconds, error)] reach `error`, on a straight line in log-log
    between the neighbours, or along the last or first two where none encloses it."""
    runs = sorted(runs)
    pairs = list(zip(runs, runs[1:]))
    enclosing = [p for p in pairs if p[0][1] >= error >= p[1][1]]
    (t0, e0), (t1, e1) = enclosing[0] if enclosing else \
        (pairs[0] if error > runs[0][1] else pairs[-1])
    slope = math.log(t1 / t0) / math.log(e1 / e0)
    return t0 * (error / e0) ** slope
