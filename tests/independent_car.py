"""A car with finite rotations, gravity and stops a second time, from its coordinates alone.

All elements' coordinates are written once, for complex numbers; their slopes by the displacements
come from a complex step, so no force's direction and no moment is written down anywhere.
"""

import numpy as np

G = 9.80665
STEP = 1e-30


class FiniteCar:
    """Mass, and what springs, dashpots and stops hold; bodies as (y, z, phi), the wheelset last."""

    def __init__(self, vehicle):
        bodies = sorted(vehicle.bodies, key=lambda b: b.name == vehicle.wheelset)
        self.n = 3 * len(bodies)
        self.mass = np.array([m for b in bodies for m in (b.mass, b.mass, b.roll_inertia)])
        self.centre = -np.array([b.height for b in bodies])
        number = {b.name: k for k, b in enumerate(bodies)}
        self.ends, self.laws = [], []
        for spring in vehicle.springs:
            self.join(number, spring, self.spring(bodies, number, vehicle, spring))
        for dashpot in vehicle.dashpots:
            self.join(number, dashpot, self.dashpot(dashpot))
        for stop in vehicle.stops:
            self.join(number, stop, self.stop(stop))
        self.bars = [
            (*(number[b] for b in bar.bodies), bar.stiffness) for bar in vehicle.anti_roll_bars
        ]
        ends = np.array([end[:5] for end in self.ends])
        self.first, self.second = ends[:, 0].astype(int), ends[:, 1].astype(int)
        self.y, self.z_first, self.z_second = ends[:, 2], -ends[:, 3], -ends[:, 4]
        self.vertical = np.array([end[5] for end in self.ends])

    def join(self, number, element, law):
        for side in (1.0, -1.0) if element.pair else (1.0,):
            self.ends.append((
                *(number[b] for b in element.bodies), side * element.lateral, *element.end_heights,
                element.direction == "vertical",
            ))  # fmt: skip
            self.laws.append(law)

    def spring(self, bodies, number, vehicle, spring):
        """Force over travel; what a vertical one bears at rest is its share of the weight above."""
        borne = 0.0
        if spring.direction == "vertical":
            upper = max(spring.bodies, key=lambda name: bodies[number[name]].height)
            above = bodies[number[upper]].height
            weight = G * sum(b.mass for b in bodies if b.height >= above)
            level = [
                (2.0 if s.pair else 1.0) * s.stiffness
                for s in vehicle.springs
                if s.direction == "vertical" and set(s.bodies) == set(spring.bodies)
            ]
            borne = weight * spring.stiffness / sum(level)
            borne *= 1.0 if spring.bodies[0] == upper else -1.0
        return lambda d, v: (borne + spring.stiffness * d, 0.0)

    def dashpot(self, dashpot):
        knee = np.inf if dashpot.knee is None else dashpot.knee

        def law(d, v):
            slow = np.clip(v, -knee, knee)
            force = dashpot.damping * slow + dashpot.damping_beyond * (v - slow)
            return force, force * v

        return law

    def stop(self, stop):
        if stop.gap is not None:
            gap, stiffness = stop.travel_factor * stop.gap, stop.force_factor * stop.stiffness

            def table(far):
                return stiffness * max(far - gap, 0.0)
        else:
            travel = stop.travel_factor * np.array(stop.travel)
            force = stop.force_factor * np.array(stop.force)
            last = (force[-1] - force[-2]) / (travel[-1] - travel[-2])

            def table(far):
                return np.interp(far, travel, force) + last * max(far - travel[-1], 0.0)

        def law(d, v):
            side = np.sign(d)
            spring = table(abs(d))
            whole = max(spring + stop.damping * v * side, 0.0) if spring > 0.0 else 0.0
            return side * whole, (side * whole - side * spring) * v

        return law

    def coordinates(self, q):
        """Travel of each element along its direction, for any number of rows of q."""
        q = q.reshape(-1, self.n // 3, 3)

        def point(body, z):
            angle = q[:, body, 2]
            arm = z - self.centre[body]
            return (
                q[:, body, 0] + np.cos(angle) * self.y - np.sin(angle) * arm,
                q[:, body, 1] + self.centre[body] + np.sin(angle) * self.y + np.cos(angle) * arm,
            )

        one, other = point(self.first, self.z_first), point(self.second, self.z_second)
        mean = 0.5 * (q[:, self.first, 2] + q[:, self.second, 2])
        y, z = one[0] - other[0], one[1] - other[1]
        return np.where(
            self.vertical,
            np.cos(mean) * z - np.sin(mean) * y - (self.z_first - self.z_second),
            np.cos(mean) * y + np.sin(mean) * z,
        )

    def at_work(self, q, speed):
        """Forces that hold the bodies where they are, and the power that is lost."""
        shifted = q + 1j * STEP * np.eye(self.n)
        slopes = self.coordinates(shifted).imag / STEP
        travel, rate = self.coordinates(q)[0], speed @ slopes
        found = [law(d, v) for law, d, v in zip(self.laws, travel, rate, strict=True)]
        held = slopes @ [force for force, _ in found]
        for first, second, stiffness in self.bars:
            twist = stiffness * (q[3 * first + 2] - q[3 * second + 2])
            held[3 * first + 2] += twist
            held[3 * second + 2] -= twist
        return held, sum(lost for _, lost in found)


class LinearCar:
    """The same of a car with matrices."""

    def __init__(self, mass, damping, stiffness):
        self.mass, self.damping, self.stiffness, self.n = mass, damping, stiffness, len(mass)

    def at_work(self, q, speed):
        force = self.damping @ speed
        return self.stiffness @ q + force, speed @ force

    def sag(self, weight):
        """Displacements under the weight, the wheelset held."""
        return np.linalg.solve(self.stiffness[:-3, :-3], weight[:-3])
