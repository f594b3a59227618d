"""Fitted curves with the intervals of their parameters: profiles, sandwich, bootstrap."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from railquake.fragility.probit import (
    LARGEST_BETA,
    Array,
    Flags,
    along,
    inverse,
    log_likelihood,
    objective,
    rising,
    slopes,
    terms,
)

__all__ = [
    "ALL_EVENTS", "NO_EVENTS", "NO_RISE", "SEPARATED", "UNBOUNDED", "Fits", "bootstrap",
    "quantile",
]  # fmt: skip

REACH = 1e3  # theta's interval ends at the smallest and largest measure over and times this
ROOT_TOLERANCE = 1e-4  # of the end of an interval, in standard deviations

SEPARATED = "separated"
NO_EVENTS = "no events"
ALL_EVENTS = "all events"
NO_RISE = "no rise"
UNBOUNDED = "interval not bounded by the data"


@dataclass(frozen=True)
class Fits:
    """Fits of the same kind to several sets of data, shape (sets, n).

    The regression is on ``z``, ln x centred and scaled: eta = a + b z.
    """

    z: Array
    y: Array
    weights: Array
    centre: Array
    scale: Array
    point: Array  # (sets, 2): a, b
    penalty: Array  # (sets,): 1 where Jeffreys' prior is added
    separated: Flags
    flat: Flags
    reach: Array  # (sets, 2): outermost ln theta, in z

    @classmethod
    def of(cls, x: Array, y: Any, weights: Array) -> Fits:
        """Fits to measures ``x`` and outcomes ``y``, a set for each row of ``weights``."""
        shape = weights.shape
        ln_x = np.broadcast_to(np.log(x), shape)
        happened = np.broadcast_to(np.asarray(y, dtype=float), shape)
        total = weights.sum(axis=1)
        centre = (weights * ln_x).sum(axis=1) / total
        spread = np.sqrt((weights * (ln_x - centre[:, None]) ** 2).sum(axis=1) / total)
        scale = np.where(spread > 1e-12, spread, 1.0)
        z = (ln_x - centre[:, None]) / scale[:, None]
        there = weights > 0.0
        most = np.where(there & (happened < 0.5), z, -np.inf).max(axis=1)
        least = np.where(there & (happened > 0.5), z, np.inf).min(axis=1)
        # no overlap: also without any, or with nothing but events
        separated = most <= least
        penalty = separated.astype(float)
        point, flat = rising(z, happened, weights, penalty, scale / LARGEST_BETA)
        edge = math.log(REACH)
        low = np.where(there, z, np.inf).min(axis=1) - edge / scale
        high = np.where(there, z, -np.inf).max(axis=1) + edge / scale
        return cls(
            z, happened, weights, centre, scale, point, penalty, separated, flat,
            np.column_stack([low, high]),
        )  # fmt: skip

    def penalised(self) -> Fits:
        """The same with Jeffreys' prior everywhere."""
        penalty = np.ones_like(self.penalty)
        point, _ = rising(self.z, self.y, self.weights, penalty, self.scale / LARGEST_BETA)
        return replace(self, penalty=penalty, point=point)

    @property
    def beta(self) -> Array:
        """Dispersion."""
        return self.scale / self.point[:, 1]

    @property
    def theta(self) -> Array:
        """Median."""
        theta: Array = np.exp(self.centre - self.scale * self.point[:, 0] / self.point[:, 1])
        return theta

    @property
    def log_likelihood(self) -> Array:
        """At the fit, without penalty."""
        return log_likelihood(self.z, self.y, self.weights, self.point)

    def flags(self, k: int) -> tuple[str, ...]:
        """Why the data of a set do not determine its curve; empty if they do."""
        events = (self.weights[k] * self.y[k]).sum()
        found = []
        if events == 0.0:
            found.append(NO_EVENTS)
        elif events == self.weights[k].sum():
            found.append(ALL_EVENTS)
        elif self.separated[k]:
            found.append(SEPARATED)
        if self.flat[k]:
            found.append(NO_RISE)
        return tuple(found)

    def intervals(self, quantile: float, labels: Any = None) -> tuple[Array, Array, Flags]:
        """Profile intervals of theta and beta, (sets, 2) each, and whether the data bound them."""
        _, information, _ = slopes(self.z, self.y, self.weights, self.penalty, self.point)
        variance = inverse(information)
        robust = variance if labels is None else self._sandwich(variance, labels)
        a, b = self.point.T
        # ln theta is -a/b, beta 1/b: gradients for the delta method
        gradients = (
            np.column_stack([-1.0 / b, a / b**2]),
            np.column_stack([0.0 * b, 1.0 + 0.0 * b]),
        )
        best = objective(self.z, self.y, self.weights, self.penalty, self.point)
        low, high = np.empty((len(a), 2)), np.empty((len(a), 2))
        bounded = np.ones(len(a), dtype=bool)
        for k, gradient in enumerate(gradients):
            spread = np.sqrt(np.einsum("si,sij,sj->s", gradient, variance, gradient))
            wide = np.sqrt(np.einsum("si,sij,sj->s", gradient, robust, gradient))
            # never narrower than for independent runs
            bound = quantile * np.maximum(wide / spread, 1.0)
            centre = -a / b if k == 0 else b
            limits = (
                (np.minimum(self.reach[:, 0], centre), np.maximum(self.reach[:, 1], centre))
                if k == 0
                else (self.scale / LARGEST_BETA, np.full(len(b), np.inf))
            )
            for sign, limit, target in zip((-1.0, 1.0), limits, (low, high), strict=True):
                target[:, k], found = self._profile_end(
                    k, centre, sign * spread, bound, limit, best
                )
                bounded &= found
        theta = [np.exp(self.centre + self.scale * side[:, 0]) for side in (low, high)]
        beta = [self.scale / side[:, 1] for side in (high, low)]
        return np.column_stack([theta[0], beta[0]]), np.column_stack([theta[1], beta[1]]), bounded

    def _profile_end(
        self, which: int, centre: Array, step: Array, bound: Array, limit: Array, best: Array
    ) -> tuple[Array, Flags]:
        """Where the root of twice the profile's fall reaches ``bound``; whether before ``limit``.

        The root is nearly a straight line in the parameter, so false position converges quickly
        from the end of Wald's interval; the bracket keeps it safe.
        """
        up = step[0] > 0.0
        cut = np.minimum if up else np.maximum
        inner, at_inner = centre.copy(), -bound
        nuisance = self.point[:, 1 - which].copy()
        reach = 0.4 * step * bound
        outer = cut(centre + step * bound, limit)
        at_outer, nuisance = self._root(which, outer, nuisance, best)
        at_outer -= bound
        for _ in range(60):  # until it brackets
            k = np.flatnonzero((at_outer < 0.0) & (outer != limit))
            if not k.size:
                break
            inner[k], at_inner[k] = outer[k], at_outer[k]
            reach[k] *= 1.5
            outer[k] = cut(outer[k] + reach[k], limit[k])
            value, nuisance[k] = self._only(k)._root(which, outer[k], nuisance[k], best[k])
            at_outer[k] = value - bound[k]
        found = at_outer >= 0.0
        end = np.where(found, outer, limit)
        k = np.flatnonzero(found & (at_outer > ROOT_TOLERANCE))
        for _ in range(60):  # false position, Illinois
            if not k.size:
                break
            share = at_outer[k] / (at_outer[k] - at_inner[k])
            end[k] = outer[k] - share * (outer[k] - inner[k])
            value, nuisance[k] = self._only(k)._root(which, end[k], nuisance[k], best[k])
            value -= bound[k]
            beyond = value >= 0.0
            out, within = k[beyond], k[~beyond]
            outer[out], at_outer[out] = end[out], value[beyond]
            at_inner[out] *= 0.5
            inner[within], at_inner[within] = end[within], value[~beyond]
            at_outer[within] *= 0.5
            k = k[np.abs(value) > ROOT_TOLERANCE]
        return end, found

    def _only(self, k: Any) -> Fits:
        """Some of the fits."""
        return Fits(**{item.name: getattr(self, item.name)[k] for item in fields(self)})

    def _root(self, which: int, at: Array, start: Array, best: Array) -> tuple[Array, Array]:
        """Root of twice the fall of the profile where theta (0) or the slope (1) is held."""
        zero, one = np.zeros(len(at)), np.ones(len(at))
        if which == 0:  # eta = b (z - place)
            base, direction = np.column_stack([zero, zero]), np.column_stack([-at, one])
        else:
            base, direction = np.column_stack([zero, at]), np.column_stack([one, zero])
        s = along(self.z, self.y, self.weights, self.penalty, base, direction, start)
        if which == 0:
            s = np.maximum(s, 0.0)  # the probability does not fall
        point = base + s[:, None] * direction
        value = objective(self.z, self.y, self.weights, self.penalty, point)
        return np.sqrt(np.maximum(2.0 * (best - value), 0.0)), s

    def _sandwich(self, variance: Array, labels: Any) -> Array:
        """Covariance for runs that depend on each other within a record (Liang & Zeger 1986)."""
        clusters = int(labels.max()) + 1
        residual = self.weights * terms(self.z, self.y, self.point)[0]
        belongs = (labels[:, None] == np.arange(clusters)).astype(float)
        sums = np.stack([residual @ belongs, (residual * self.z) @ belongs], axis=-1)
        meat = np.einsum("sci,scj->sij", sums, sums) * clusters / (clusters - 1)
        return variance @ meat @ variance


def quantile(confidence: float, clusters: int) -> float:
    """Of Student's t with a degree of freedom less than clusters; normal where there are none."""
    from scipy.stats import norm, t

    if clusters:
        return float(t.ppf(0.5 + 0.5 * confidence, clusters - 1))
    return float(norm.ppf(0.5 + 0.5 * confidence))


def bootstrap(x: Array, y: Flags, labels: Any, replicates: int, seed: int) -> Array:
    """Fits to data drawn again, whole records at a time; ln theta and beta."""
    rng = np.random.default_rng(seed)
    clusters = int(labels.max()) + 1
    found = []
    size = max(1, 400_000 // x.size)  # so that memory stays small
    for first in range(0, replicates, size):
        count = min(size, replicates - first)
        drawn = rng.multinomial(clusters, np.full(clusters, 1.0 / clusters), size=count)
        fits = Fits.of(x, y, drawn[:, labels].astype(float))
        found.append(np.column_stack([np.log(fits.theta), fits.beta]))
    return np.concatenate(found)
