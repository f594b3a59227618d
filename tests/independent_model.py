"""The coupled system a second time: plain NumPy and SciPy, no code of `railquake.physics`.

Written from the equations alone, and otherwise than the package does it: forces by vector geometry
at the point of contact instead of derivatives of a gap, Hertz by Johnson's formulas in the ratio of
the semi-axes, the hinge as differential equations, and everything marched together by an implicit
method with error control that stops wherever a patch opens or closes.  Only inputs are shared: the
numbers of a scenario and the points of its profiles.  Frame: y right, z down, roll right side down.
"""

from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.special import ellipe, ellipk

from independent_car import FiniteCar, LinearCar

G = 9.80665
CATCH_UP = 1e5  # 1/s, the rate at which the hinge's largest rotation follows a new one
STEEP = 4.0  # slope of the rail's head from which its face goes on as a straight line
SIDES = np.array([-1.0, -1.0, 1.0, 1.0])  # patches: tread, flange of the left; of the right


def vehicle_matrices(vehicle):
    """M, C, K of rigid bodies (y, z, phi each), wheelset last, from every element's elongation."""
    bodies = sorted(vehicle.bodies, key=lambda b: b.name == vehicle.wheelset)
    place = {b.name: 3 * i for i, b in enumerate(bodies)}
    height = {b.name: b.height for b in bodies}

    def matrix(elements, coefficient):
        total = np.zeros((3 * len(bodies), 3 * len(bodies)))
        for e in elements:
            for side in (1.0, -1.0) if e.pair else (1.0,):
                longer = np.zeros(len(total))
                for name, end, sign in zip(e.bodies, e.end_heights, (1.0, -1.0), strict=True):
                    turned = end - height[name] if e.direction == "lateral" else side * e.lateral
                    longer[place[name] + (e.direction == "vertical")] += sign
                    longer[place[name] + 2] += sign * turned
                total += getattr(e, coefficient) * np.outer(longer, longer)
        return total

    mass = np.array([m for b in bodies for m in (b.mass, b.mass, b.roll_inertia)])
    return mass, matrix(vehicle.dashpots, "damping"), matrix(vehicle.springs, "stiffness")


def column_matrices(pier):
    """M, C, K of a column by its ends' rotations from the chord; C on the first two modes.

    The hinge's damping is in C where it is that of its initial stiffness.
    """
    length, ei = pier.length, pier.youngs_modulus * pier.second_moment_of_area
    from_chord = np.array([[1.0 / length, 1.0, 0.0], [1.0 / length, 0.0, 1.0]])
    stiffness = from_chord.T @ (ei / length * np.array([[4.0, 2.0], [2.0, 4.0]])) @ from_chord
    mass = np.array([pier.mass, pier.base_rotational_inertia, pier.rotational_inertia])
    whole = stiffness + np.diag([0.0, pier.bouc_wen.k0, 0.0])
    w = np.sqrt(np.sort(np.linalg.eigvals(whole / mass[:, None]).real)[:2])
    a, b = np.linalg.solve(np.column_stack([0.5 / w, 0.5 * w]), 2 * [pier.damping_ratio])
    damped = {"column": stiffness, "initial": whole}[pier.damping_of]
    return mass, a * np.diag(mass) + b * damped, stiffness


def hinge_rates(h, x, v, z, eps, largest):
    """Moment of the hinge, and the rates of z, eps and of the largest rotation."""
    reach = max(largest, abs(x))
    d = h.rho_eps * h.m * eps / (h.Fy * h.xu) + h.rho_x * reach / h.xu
    big_a = np.exp(-h.delta_k * d * np.exp(-h.phi * d))
    beta = h.beta0 * big_a * np.exp(h.n * h.delta_f * d)
    pinching = np.exp(-0.5 * (abs(x) / h.sigma) ** h.u) * (1 - np.exp(-0.5 * (eps / h.eps_p) ** 8))
    kp = h.k0 * (1.0 - h.rho_p * pinching)
    z_rate = big_a * v - beta * (abs(v) * abs(z) ** (h.n - 1.0) * z + h.eta0 * v * abs(z) ** h.n)
    moment = h.alpha * kp * x + (1.0 - h.alpha) * kp * z
    return moment, (z_rate, (1.0 - h.alpha) * kp * z * v / h.m, CATCH_UP * (reach - largest))


class Contact:
    """Where the four patches touch, and what they press."""

    def __init__(self, scenario, kalker):
        pair = scenario.wheelrail
        wheel, rail = pair.wheel_profile(), pair.rail_profile()
        arc = wheel.arc_length
        points = np.column_stack([pair.running_circle + wheel.y, pair.rolling_radius + wheel.z])
        self.wheel = CubicSpline(arc, points)
        self.wheel_curvature = 0.5 * (arc[1:] + arc[:-1]), wheel.curvature
        self.search = np.linspace(0.0, arc[-1], int(arc[-1] / 0.4e-3))
        dy, dz = self.wheel(self.search, 1).T
        self.nodes = self.wheel(self.search)
        steep = (np.abs(dz) > np.tan(0.2) * np.abs(dy)) & (self.nodes[:, 0] < pair.running_circle)
        flange = self.search[steep].max()
        self.zones = np.array([[flange, arc[-1]], [0.0, flange]] * 2)  # tread, flange; twice
        self.in_zone = [(self.search >= a) & (self.search <= b) for a, b in self.zones[:2]]
        crown = int(np.argmin(rail.z))
        y, z = rail.y + pair.rail_half_distance(rail), rail.z - rail.z[crown]
        inside = np.abs(np.gradient(z, y)) < STEEP
        self.rail_ends = y[inside][[0, -1]]
        self.rail = CubicSpline(y[inside], z[inside])
        self.rail_curvature = 0.5 * (y[1:] + y[:-1]), rail.curvature
        wide = np.linspace(y[0] - 0.2, y[-1] + 0.2, 8000)
        self.rail_nodes = wide, self.rail_at(wide)[0]
        self.pair, self.axles = pair, scenario.vehicle.axles
        self.train = scenario.vehicle.speed
        self.speed = max(self.train, pair.speed_bound)
        wheelset = next(b for b in scenario.vehicle.bodies if b.name == scenario.vehicle.wheelset)
        estimate = 0.3 * wheelset.mass / self.axles * pair.rolling_radius**2
        self.axle_inertia = scenario.vehicle.axle_inertia or estimate
        self.alpha_r = 1.5 * (1.0 - pair.restitution)
        self.modulus = pair.youngs_modulus / (2.0 * (1.0 - pair.poisson_ratio**2))
        self.shear = pair.youngs_modulus / (2.0 * (1.0 + pair.poisson_ratio))
        # ellipses by the ratio k of their semi-axes (Johnson 1985, section 4.2)
        k = np.concatenate([np.geomspace(1e-3, 0.5, 3000), 1.0 - np.geomspace(0.49, 1e-10, 3000)])
        first, second = ellipk(1.0 - k**2), ellipe(1.0 - k**2)
        self.curvatures = (first - second) / (second / k**2 - first)  # smaller over larger
        self.ellipse = (
            k,
            2.0 * np.pi / 3.0 * np.sqrt(second) / (k * first**1.5),
            second / (k * first),
        )
        # Kalker's coefficients at this Poisson's ratio, along the logarithm of a/b
        nu = pair.poisson_ratio
        weights = np.array(
            [(nu - 0.25) * (nu - 0.5) * 8.0, nu * (0.5 - nu) * 16.0, nu * (nu - 0.25) * 8.0]
        )
        self.kalker = kalker["place"], *(np.log(kalker[f"C{n}"] @ weights) for n in (11, 22, 23))

    def rail_at(self, y):
        """Height, slope and second derivative."""
        held = np.minimum(np.maximum(y, self.rail_ends[0]), self.rail_ends[1])
        height, slope, bend = _at(self.rail, held)
        return height + slope * (y - held), slope, np.where(held == y, bend, 0.0)

    def find(self, shift, roll):
        """Of each patch, as of a right-hand wheel: gap at Z = 0, arc, rail y, height, slope."""
        sines, cosine = SIDES * np.sin(roll), np.cos(roll)
        shifts = SIDES * shift
        at = np.empty(4)
        for side in (0, 2):
            y = shifts[side] + self.nodes[:, 0] * cosine - self.nodes[:, 1] * sines[side]
            height = np.interp(y, *self.rail_nodes)
            gap = height - self.nodes[:, 0] * sines[side] - self.nodes[:, 1] * cosine
            for zone in range(2):
                here = self.in_zone[zone]
                at[side + zone] = self.search[here][np.argmin(gap[here])]
        for _ in range(3):  # Newton on the gap's slope along the wheel
            (s, q), rate, bend = (v.T for v in _at(self.wheel, at))
            y = shifts + s * cosine - q * sines
            height, slope, curving = self.rail_at(y)
            y1, z1 = rate[0] * cosine - rate[1] * sines, rate[0] * sines + rate[1] * cosine
            y2, z2 = bend[0] * cosine - bend[1] * sines, bend[0] * sines + bend[1] * cosine
            first, second = slope * y1 - z1, curving * y1**2 + slope * y2 - z2
            move = np.where(second > 0.0, -first / np.where(second > 0.0, second, 1.0), 0.0)
            move = np.minimum(np.maximum(move, -4e-4), 4e-4)
            at = np.minimum(np.maximum(at + move, self.zones[:, 0]), self.zones[:, 1])
        s, q = _at(self.wheel, at)[0].T
        y = shifts + s * cosine - q * sines
        height, slope, _ = self.rail_at(y)
        return height - s * sines - q * cosine, at, y, height, slope

    def patches(self, wheelset, velocity, track, track_velocity, damping, turning):
        """Penetrations, approach rates, and the force on the wheelset and on the track of all four.

        ``wheelset`` and ``track`` are (y, z, roll), heights from the level of the crowns at rest;
        ``turning`` is the rate of an axle.
        """
        turn = np.array(
            [[np.cos(track[2]), np.sin(track[2])], [-np.sin(track[2]), np.cos(track[2])]]
        )
        shift, centre = turn @ (wheelset[:2] - track[:2])
        roll = wheelset[2] - track[2]
        gap, at, y, height, slope = self.find(shift, roll)
        penetration = centre - gap
        cosine = 1.0 / np.hypot(1.0, slope)
        # in track axes, of the patch as it stands: point, normal out of the rail, tangent outwards
        point = np.column_stack([SIDES * y, height])
        normal = np.column_stack([SIDES * slope * cosine, -cosine])
        tangent = np.column_stack([-normal[:, 1], normal[:, 0]])
        from_wheelset = point - (shift, centre)

        def moving(origin, spin, arm):
            return turn @ origin + spin * np.column_stack([-arm[:, 1], arm[:, 0]])

        relative = moving(velocity[:2], velocity[2], from_wheelset) - moving(
            track_velocity[:2], track_velocity[2], point
        )
        approach = -np.sum(relative * normal, axis=1)
        delta = np.maximum(penetration, 0.0) * cosine
        lateral = 0.5 * (_nearest(at, *self.wheel_curvature) + _nearest(y, *self.rail_curvature))
        lateral = np.maximum(lateral, 0.05)
        radius = _at(self.wheel, at)[0][:, 1]
        lean = np.arctan2(tangent[:, 1], tangent[:, 0]) - roll  # of the tangent from the axle
        rolling = 0.5 * np.maximum(np.cos(lean), 0.05) / radius
        ratio = np.minimum(lateral, rolling) / np.maximum(lateral, rolling)
        k, stiff, area = (np.interp(ratio, self.curvatures, c) for c in self.ellipse)
        hertz = self.modulus * stiff / np.sqrt(lateral + rolling)
        ab = area * delta / (lateral + rolling)
        a_over_b = np.where(lateral < rolling, k, 1.0 / k)
        place = np.log(a_over_b)
        c11, c22, c23 = (np.exp(np.interp(place, self.kalker[0], c)) for c in self.kalker[1:])
        n = np.maximum(hertz * delta**1.5 * (1.0 + damping * approach), 0.0)
        creepage = np.sum(relative * tangent, axis=1) / self.speed
        # forwards the wheel's point moves with V less what the axle's turning takes back
        from_axle = from_wheelset @ (-np.sin(roll), np.cos(roll))
        slip = self.train - turning * from_axle
        by_spin = -self.shear * ab**1.5 * c23 * np.sin(lean) * turning / self.speed
        linear = by_spin - self.shear * ab * c22 * creepage
        along = -self.shear * ab * c11 * slip / self.speed
        size = np.hypot(along, linear)
        limit = np.maximum(self.pair.friction * n, 1e-30)
        tau = np.minimum(size / limit, 3.0)
        share = limit * (tau - tau**2 / 3.0 + tau**3 / 27.0) / np.where(size == 0.0, 1.0, size)
        t, forward = share * linear, share * along
        force = self.axles * (n[:, None] * normal + t[:, None] * tangent)
        on_wheelset = np.append(turn.T @ force.sum(0), np.sum(_cross(from_wheelset, force)))
        on_track = np.append(-turn.T @ force.sum(0), -np.sum(_cross(point, force)))
        return SimpleNamespace(
            penetration=penetration,
            approach=approach,
            on_wheelset=on_wheelset,
            on_track=on_track,
            place=(shift, centre, roll),
            force=force,  # of each patch on the wheelset, in track axes
            used=np.where(delta > 0.0, tau / 3.0, 0.0),  # of friction; 1 where it slides
            stored=self.axles * np.sum(0.4 * hertz * delta**2.5),
            impact=self.axles * np.sum((n - hertz * delta**1.5) * approach),
            tangential=-self.axles * np.sum(t * np.sum(relative * tangent, axis=1)),
            spin=self.axles * np.sum(share * by_spin * creepage * self.speed),
            forward=-self.axles * np.sum(forward * slip),
            turning=-np.sum(forward * from_axle) / self.axle_inertia,
        )


def _at(spline, x):
    """Value, first and second derivative of a cubic spline."""
    cell = np.minimum(np.maximum(np.searchsorted(spline.x, x) - 1, 0), len(spline.x) - 2)
    c3, c2, c1, c0 = spline.c[:, cell]
    t = x - spline.x[cell]
    t = t[:, None] if c0.ndim > 1 else t
    return (
        c0 + t * (c1 + t * (c2 + t * c3)),
        c1 + t * (2.0 * c2 + 3.0 * t * c3),
        2.0 * c2 + 6.0 * t * c3,
    )


def _cross(arm, force):
    return arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]


def _nearest(at, midway, values):
    return values[np.searchsorted(midway, at)]


def _root(function, x):
    """Root by Newton's method with halved steps."""
    found = function(x)
    for _ in range(60):
        moves = 1e-6 * np.eye(len(x))
        slopes = np.column_stack([(function(x + m) - function(x - m)) / 2e-6 for m in moves])
        step, share = -np.linalg.solve(slopes, found), 1.0
        while share > 1e-6 and np.linalg.norm(function(x + share * step)) > np.linalg.norm(found):
            share *= 0.5
        x = x + share * step
        found = function(x)
        if np.abs(found).max() < 1e-10:
            return x
    raise ArithmeticError(f"no equilibrium, {np.abs(found).max()} of the weight is left")


class Whole:
    """Right-hand side of the coupled system.

    State: pier x, v; z, eps, largest; vehicle x, v; an axle's rate.
    """

    def __init__(self, scenario, kalker):
        self.contact = Contact(scenario, kalker)
        self.pier = scenario.support
        finite = scenario.vehicle.kinematics == "finite"
        self.car = (
            FiniteCar(scenario.vehicle)
            if finite
            else LinearCar(*vehicle_matrices(scenario.vehicle))
        )
        self.mass, self.n = self.car.mass, self.car.n
        bodies = sorted(scenario.vehicle.bodies, key=lambda b: b.name == scenario.vehicle.wheelset)
        self.heights = np.array([b.height for b in bodies])
        self.pier_mass, self.pier_c, self.pier_k = column_matrices(self.pier)
        e, h = self.pier.track_offset, self.pier.track_height
        self.to_track = np.array([[1.0, 0.0, -h], [0.0, 0.0, -e], [0.0, 0.0, -1.0]])
        motion = scenario.ground_motion()
        self.ground = motion.time, motion.acceleration
        lift = scenario.vertical_motion()
        self.lift = ([0.0], [0.0]) if lift is None else (lift.time, lift.acceleration)
        self.coupled = float(self.pier.coupled)
        self.weight = np.where(np.arange(self.n) % 3 == 1, self.mass * G, 0.0)
        self.sideways = np.where(np.arange(self.n) % 3 == 0, 1.0, 0.0)
        self.damping = np.zeros(4)
        self.level = np.array([0.0, scenario.wheelrail.rolling_radius, 0.0])

    def touch(self, x, v, vehicle, speed, turning):
        """Contact of the wheelset with the track as the pier's top holds it."""
        return self.contact.patches(
            vehicle[-3:] - self.level,
            speed[-3:],
            self.to_track @ x,
            self.to_track @ v,
            self.damping,
            turning,
        )

    def hinge(self, x, v, *state):
        """See `hinge_rates`; an elastic one has no memory but its largest rotation."""
        if self.pier.hinge == "elastic":
            largest = CATCH_UP * max(abs(x) - state[2], 0.0)
            return self.pier.bouc_wen.k0 * x, (0.0, 0.0, largest)
        return hinge_rates(self.pier.bouc_wen, x, v, *state)

    def parts(self, state):
        """Pier x, v; z, eps and largest rotation of the hinge; vehicle x, v; an axle's rate."""
        *parts, turning = np.split(state, [3, 6, 9, 9 + self.n, 9 + 2 * self.n])
        return *parts, turning[0]

    def rates(self, t, state):
        x, v, hinge, vehicle, speed, turning = self.parts(state)
        touch = self.touch(x, v, vehicle, speed, turning)
        moment, hinge_rate = self.hinge(x[1], v[1], *hinge)
        on_wheelset, on_track = touch.on_wheelset, self.coupled * touch.on_track
        a = np.interp(t, *self.ground)
        force = self.to_track.T @ on_track - self.pier_c @ v - self.pier_k @ x
        force -= (self.pier.mass * a, moment, 0.0)
        push = self.weight * (1.0 + np.interp(t, *self.lift) / G) - self.mass * a * self.sideways
        push -= self.car.at_work(vehicle, speed)[0]
        push[-3:] += on_wheelset
        return np.concatenate(
            [v, force / self.pier_mass, hinge_rate, speed, push / self.mass, [touch.turning]]
        )

    def at_rest(self):
        """Equilibrium, centred on the track, with the sideways creep that carries the lean."""
        h, total = self.pier.bouc_wen, self.weight.sum()
        even = self.contact.train / self.level[1]
        self.damping[:] = self.contact.alpha_r / self.contact.pair.onset_rate_bound
        foot = -np.sign(self.pier.track_offset) * 3.0 * total * abs(self.pier.track_offset) / h.k0
        sign = np.sign(foot) or 1.0
        loading = solve_ivp(
            lambda x, s: self.hinge(sign * x, sign, *s, x)[1][:2],
            (0.0, max(abs(foot), 1e-9)), [0.0, 0.0], rtol=1e-10, atol=1e-16, dense_output=True,
        ).sol  # fmt: skip

        def state(unknown):
            x = 1e-3 * unknown[:3]
            vehicle = 1e-3 * unknown[3:-1]
            turning = even * (1.0 + 1e-3 * unknown[-1])
            drift = 0.1 * vehicle[-3]
            vehicle[-3] = (self.to_track @ x)[0]
            z, eps = loading(abs(x[1]))
            return np.concatenate(
                [x, 0 * x, [z, eps, abs(x[1])], vehicle, drift * self.sideways, [turning]]
            )

        def unbalanced(unknown):
            s = state(unknown)
            x, _, hinge, vehicle, speed, turning = self.parts(s)
            touch = self.touch(x, 0 * x, vehicle, speed, turning)
            moment, _ = self.hinge(x[1], 0.0, *hinge)
            on_pier = self.coupled * self.to_track.T @ touch.on_track - self.pier_k @ x
            on_pier[1] -= moment
            push = self.weight - self.car.at_work(vehicle, 0.0 * vehicle)[0]
            push[-3:] += touch.on_wheelset
            balance = touch.turning * self.contact.axle_inertia / self.level[1]
            return np.concatenate([on_pier, push, [balance]]) / total

        whole = self.pier_k + np.diag([0.0, h.k0, 0.0])
        x = self.coupled * np.linalg.solve(whole, self.to_track.T @ [0.0, total, 0.0])
        y, z, roll = self.to_track @ x
        vehicle = np.zeros(self.n)
        if isinstance(self.car, LinearCar):  # the other one is drawn as it stands
            vehicle[:-3] = self.car.sag(self.weight)
        vehicle += np.tile([0.0, z + 8e-5, roll], self.n // 3)
        vehicle[0::3] += y + roll * self.heights
        guess = 1e3 * np.concatenate([x, vehicle, [0.0]])
        guess[-4] = 0.0
        return state(_root(unbalanced, guess))


def solve(scenario, kalker, times, rtol=1e-6, push=0.0):
    """Histories of a scenario on a pier, at ``times``, the first of them 0.

    It starts at rest, with ``push`` added to the state.

    Returns the states at these times (see `Whole.parts`), what touches then, the model, and the
    number of times that a patch opened or closed.
    """
    whole = Whole(scenario, kalker)
    contact, state, t = whole.contact, whole.at_rest() + push, 0.0
    scale = np.repeat([1e-7, 1e-5, 1e-8, 1e-7, 1e-5, 1e-5], [3, 3, 3, whole.n, whole.n, 1])
    memory = {}

    def touching(s):
        if s.tobytes() not in memory:
            memory.clear()
            x, v, _, vehicle, speed, turning = whole.parts(s)
            memory[s.tobytes()] = whole.touch(x, v, vehicle, speed, turning)
        return memory[s.tobytes()]

    closed = touching(state).penetration > 0.0
    whole.damping = np.where(closed, whole.damping, 0.0)
    memory.clear()

    def crossing(i):
        def depth(t, s):
            return touching(s).penetration[i]

        depth.terminal, depth.direction = True, -1.0 if closed[i] else 1.0
        return depth

    states, touches, changes = [state], [touching(state)], 0
    while t < times[-1]:
        run = solve_ivp(
            whole.rates, (t, times[-1]), state, method="BDF", rtol=rtol, atol=1e3 * rtol * scale,
            events=[crossing(i) for i in range(4)], dense_output=True, max_step=2e-3,
            first_step=1e-7,
        )  # fmt: skip
        if run.status < 0:
            raise ArithmeticError(run.message)
        memory.clear()
        for time in times[(times > t) & (times <= run.t[-1])]:
            states.append(run.sol(time))
            touches.append(touching(states[-1]))
        t, state = run.t[-1], run.y[:, -1]
        for i in range(4):
            if len(run.t_events[i]):
                closed[i] = not closed[i]
                onset = max(touching(state).approach[i], contact.pair.onset_rate_bound)
                whole.damping[i] = contact.alpha_r / onset if closed[i] else 0.0
                changes += 1
        memory.clear()
    return np.array(states), touches, whole, changes
