r"""Probit regression of an outcome on ln x, many sets of weights at once.

The probability is :math:`\Phi(a + b z)`, z being ln x centred and scaled; every function takes
arrays of shape (sets, n) and a point (a, b) for each set.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

__all__ = [
    "LARGEST_BETA", "Array", "Flags", "along", "inverse", "log_likelihood", "objective", "rising",
    "slopes", "terms",
]  # fmt: skip

Array = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

LARGEST_BETA = 10.0  # a curve that flat says nothing; beyond, the measure does not matter
ITERATIONS = 100
LINE_ITERATIONS = 40
LINE_TOLERANCE = 1e-4  # a profile errs by its square
TOLERANCE = 1e-9  # of the last step of Newton's iteration, in standard deviations of ln x


def terms(z: Array, y: Array, point: Array) -> tuple[Array, Array, Array]:
    """Of each run: score and expected information for eta, and the slope of ln information."""
    from scipy.special import erfcx

    eta = np.clip(point[:, :1] + point[:, 1:] * z, -35.0, 35.0)
    size = np.abs(eta)
    density = np.exp(-0.5 * eta * eta) / math.sqrt(2.0 * math.pi)
    tail = math.sqrt(2.0 / math.pi) / erfcx(size / math.sqrt(2.0))  # density over Phi(-size)
    body = density / (1.0 - density / tail)  # over Phi(size)
    up, down = np.where(eta > 0.0, body, tail), np.where(eta > 0.0, tail, body)
    return y * up - (1.0 - y) * down, up * down, -2.0 * eta - up + down


def slopes(
    z: Array, y: Array, weights: Array, penalty: Array, point: Array
) -> tuple[Array, Array, Array]:
    """Gradient of the (penalised) log-likelihood, expected information, its determinant."""
    score, information, slope = terms(z, y, point)
    w = weights * information
    matrix = np.empty((len(point), 2, 2))
    matrix[:, 0, 0] = w.sum(axis=1)
    matrix[:, 0, 1] = matrix[:, 1, 0] = (w * z).sum(axis=1)
    matrix[:, 1, 1] = (w * z * z).sum(axis=1)
    determinant = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] ** 2
    pull = weights * score
    if penalty.any():
        covariance = inverse(matrix)
        leverage = w * (
            covariance[:, 0, 0, None]
            + 2.0 * covariance[:, 0, 1, None] * z
            + covariance[:, 1, 1, None] * z * z
        )
        pull = pull + 0.5 * penalty[:, None] * leverage * slope
    gradient = np.column_stack([pull.sum(axis=1), (pull * z).sum(axis=1)])
    return gradient, matrix, determinant


def inverse(matrix: Array) -> Array:
    """Of symmetric 2 x 2 matrices."""
    determinant = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] ** 2
    out = np.empty_like(matrix)
    out[:, 0, 0], out[:, 1, 1] = matrix[:, 1, 1], matrix[:, 0, 0]
    out[:, 0, 1] = out[:, 1, 0] = -matrix[:, 0, 1]
    out /= np.maximum(determinant, 1e-300)[:, None, None]
    return out


def log_likelihood(z: Array, y: Array, weights: Array, point: Array) -> Array:
    """Without penalty."""
    from scipy.special import log_ndtr

    eta = np.clip(point[:, :1] + point[:, 1:] * z, -35.0, 35.0)
    total: Array = (weights * log_ndtr((2.0 * y - 1.0) * eta)).sum(axis=1)
    return total


def objective(z: Array, y: Array, weights: Array, penalty: Array, point: Array) -> Array:
    """What is made largest: the log-likelihood, with Jeffreys' prior where ``penalty`` is 1."""
    value = log_likelihood(z, y, weights, point)
    if penalty.any():
        _, _, determinant = slopes(z, y, weights, 0.0 * penalty, point)
        value = value + 0.5 * penalty * np.log(np.maximum(determinant, 1e-300))
    return value


def _maximum(z: Array, y: Array, weights: Array, penalty: Array) -> Array:
    """Maximum of the (penalised) likelihood by Fisher's scoring with halved steps."""
    from scipy.special import ndtri

    total = weights.sum(axis=1)
    share = ((weights * y).sum(axis=1) + 0.5) / (total + 1.0)
    point = np.column_stack([ndtri(share), np.full(len(z), 0.1)])
    active = np.ones(len(z), dtype=bool)
    value = objective(z, y, weights, penalty, point)
    for _ in range(ITERATIONS):
        k = np.flatnonzero(active)
        if not k.size:
            break
        data = z[k], y[k], weights[k], penalty[k]
        gradient, information, _ = slopes(*data, point[k])
        step = np.einsum("sij,sj->si", inverse(information), gradient)
        step *= np.minimum(1.0, 5.0 / np.maximum(np.abs(step).max(axis=1), 1e-300))[:, None]
        moved = point[k] + step
        new = objective(*data, moved)
        for _ in range(30):
            worse = new < value[k] - 1e-12 * np.abs(value[k])
            if not worse.any():
                break
            step[worse] *= 0.5
            moved = point[k] + step
            new = objective(*data, moved)
        point[k], value[k] = moved, new
        active[k] = np.abs(step).max(axis=1) > TOLERANCE * np.maximum(
            1.0, np.abs(moved).max(axis=1)
        )
    return point


def rising(
    z: Array, y: Array, weights: Array, penalty: Array, smallest: Array
) -> tuple[Array, Flags]:
    """The maximum among slopes of at least ``smallest``, and where that bound holds it."""
    point = _maximum(z, y, weights, penalty)
    flat = ~(point[:, 1] > smallest)
    if flat.any():
        zero = np.zeros(int(flat.sum()))
        held = np.column_stack([zero, smallest[flat]])
        direction = np.column_stack([zero + 1.0, zero])
        data = z[flat], y[flat], weights[flat], penalty[flat]
        point[flat, 0] = along(*data, held, direction, point[flat, 0])
        point[flat, 1] = smallest[flat]
    return point, flat


def along(
    z: Array, y: Array, weights: Array, penalty: Array, base: Array, direction: Array, start: Array
) -> Array:
    """Maximum along a line of (a, b), from ``start``."""
    s, last = start.copy(), np.zeros_like(start)
    k = np.arange(len(s))
    for _ in range(LINE_ITERATIONS):
        point = base[k] + s[k, None] * direction[k]
        gradient, information, _ = slopes(z[k], y[k], weights[k], penalty[k], point)
        slope = np.einsum("si,si->s", gradient, direction[k])
        curvature = np.einsum("si,sij,sj->s", direction[k], information, direction[k])
        step = slope / np.maximum(curvature, 1e-300)
        # where it turned round the maximum lies between: half the last step at most
        turned = step * last[k] < 0.0
        reach = np.where(turned, 0.5 * np.abs(last[k]), 0.5 * np.abs(s[k]) + 1.0)
        step = np.clip(step, -reach, reach)
        s[k] += step
        last[k] = step
        k = k[np.abs(step) > LINE_TOLERANCE * np.maximum(np.abs(s[k]), 1.0)]
        if not k.size:
            break
    return s
