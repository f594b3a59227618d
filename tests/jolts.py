"""Some milliseconds in which everything happens: for quick tests of every stage of a step.

The ground jumps by ninety times gravity, so that the hinge yields and wears, and the train is
pushed over the rails into a flange and onto it.  ``verification/jolts.json`` holds what the
equations written a second time (`independent_model`) give; run this file to write it again.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import railquake as rq
from railquake.inputs.ground_motion import GroundMotion
from railquake.march.order import kernel_order
from railquake.march.step import find_contact_forces, find_free_accelerations
from stages import stage

FILE = Path(__file__).with_name("verification") / "jolts.json"
DT = 1e-5
FRAME = 1e-4
FINE = 0.02e-3  # s, between the points over which powers are summed
EVERY = 25  # of them are kept
SIDEWAYS = np.array([0.0, 500.0, 900.0, 900.0, 400.0, -600.0, -200.0])  # m/s2, each millisecond
UPWARDS = np.array([0.0, 20.0, -60.0, -60.0, 30.0, 50.0, 0.0])
PIER = {
    "preset": "bart-berkeley",
    # a foot that Newmark's method follows at this step; the preset's is next to nothing
    "base_rotational_inertia": 1e5,
    # a hinge that wears within the jolt
    "bouc_wen": {"rho_eps": 0.5, "eta0": 0.2, "rho_p": 0.4, "eps_p": 2e-4, "sigma": 4e-4, "u": 2.5},
}
# flanges as treads: the second writing knows no table
WHEELS = {"preset": "bart", "flange_creep_law": "she"}
GRAVITY_CAR = {
    "preset": "bart-under-gravity",
    "dashpots": {"secondary-lateral": {"knee": "0.2 m/s", "damping_beyond": "20 kN s/m"}},
    "stops": {
        "lateral": {"damping": "2 kN s/m"},
        "vertical": {"gap": "20 mm", "damping": "1 kN s/m"},
    },
}
# what differs, and to which side the train is pushed
JOLTS = {
    "to the right": ({}, 1.0),
    "to the left, elastic": ({"scale": -1.0, "hinge": "elastic"}, -1.0),
    "decoupled, creeping": ({"coupled": False, "speed": "0.01 km/h", "scale": 0.8}, 1.0),
    # turned far, onto its stops
    "turned, under gravity": ({"vehicle": GRAVITY_CAR}, 1.0),
}
TURNED = {"turned, under gravity": (0.08, -0.01)}  # rad, car and bogie
SHIFT, SPEED, TURNING = 6.5e-3, 1.5, 0.4  # m, m/s of all bodies, rad/s of the wheelset
STORED = json.loads(FILE.read_text(encoding="utf-8")) if FILE.is_file() else {}
STORED["times"] = FINE * np.arange(round(1e-3 * (len(SIDEWAYS) - 1) / FINE) + 1)


def jolt(name, dt=DT, sign=1.0, frame=FRAME, **pier):
    """Scenario of a jolt; with ``sign=-1`` turned round, with other values of the pier."""
    changes = dict(JOLTS[name][0])
    changes["scale"] = sign * changes.get("scale", 1.0)
    return rq.scenario(
        support={**PIER, **pier},
        motion=GroundMotion("jolt", 1e-3, SIDEWAYS),
        allow_high_pga=True,
        vertical=GroundMotion("jolt", 1e-3, UPWARDS),
        dt=dt,
        history_step=frame,
        wheelrail=WHEELS,
        **changes,
    )


def push(name):
    """What is added to the state at rest: pier x, v; hinge; vehicle x, v; an axle's rate."""
    sideways = np.tile([1.0, 0.0, 0.0], 3)
    turning = TURNING * (np.arange(9) == 8)
    turned = np.zeros(9)
    turned[[2, 5]] = TURNED.get(name, (0.0, 0.0))
    return JOLTS[name][1] * np.concatenate(
        [np.zeros(9), SHIFT * sideways + turned, SPEED * sideways + turning, [0.0]]
    )


def pushed(name, dt=DT, sign=1.0, frame=FRAME, **pier):
    """The system with the push, and with the forces and accelerations that belong to it."""
    system = rq.assemble(jolt(name, dt, sign, frame, **pier))
    return set_off(system, sign * push(name)[9:18], sign * push(name)[18:27])


def set_off(system, moved, speeds):
    """A system whose bodies are moved and thrown, with the forces and accelerations of that."""
    s, q, matrices = system.start.copy(), system.constants, system.vehicle
    state, constant = system.layout.state, system.layout.constant
    place = np.argsort(kernel_order(9))
    x, v, a = state.VEHICLE_X + place, state.VEHICLE_V + place, state.VEHICLE_A + place
    s[x, 0] += moved
    s[v, 0] += speeds
    stage(system, find_contact_forces)(s, q, system.geometry)
    for old, new in (
        (state.TRACK_FORCE_OLD, state.TRACK_FORCE),
        (state.WHEELSET_FORCE_OLD, state.WHEELSET_FORCE),
        (state.CONTACT_POWER_OLD, state.CONTACT_POWER),
    ):
        s[old : old + 3] = s[new : new + 3]
    s[state.CONTACT_POWER_OLD + 3] = s[state.CONTACT_POWER + 3]
    stage(system, find_free_accelerations)(s, q)
    force = matrices.mass * s[a, 0]
    pushed = s[state.WHEELSET_FORCE : state.WHEELSET_FORCE + 3, 0]
    force[-3:] += pushed
    s[a, 0] = s[state.VEHICLE_A_OLD + place, 0] = force / matrices.mass
    # the wheelset's, but for its contact forces
    free = s[a[-3:], 0] - pushed / matrices.mass[-3:]
    s[state.WHEELSET_FREE : state.WHEELSET_FREE + 3, 0] = free
    s[state.WHEELSET_FREE_KNOWN : state.WHEELSET_FREE_KNOWN + 3, 0] = free
    k = q[constant.K : constant.K + 6, 0]
    column = np.array([[k[0], k[1], k[2]], [k[1], k[3], k[4]], [k[2], k[4], k[5]]])
    node = q[constant.REACTION, 0] * np.array([s[state.NODE_U, 0], 0.0, s[state.NODE_THETA2, 0]])
    node[1] = -s[state.MOMENT, 0]
    pier = node - column @ s[state.U : state.U + 3, 0]
    s[state.U_A : state.U_A + 3, 0] = pier / q[constant.MASS : constant.MASS + 3, 0]
    return replace(system, start=s)


def measured(states, touches, whole):
    """What a history and the energy audit show, from the second writing, by the same names."""
    ends = [3, 6, 9, 9 + whole.n, 9 + 2 * whole.n]
    x, v, hinge, vehicle, speed, turning = np.split(states, ends, axis=1)
    track, track_v = x @ whole.to_track.T, v @ whole.to_track.T
    moment = np.array([whole.hinge(*row)[0] for row in np.column_stack([x[:, 1], v[:, 1], hinge])])
    time = STORED["times"]
    ground = np.interp(time, *whole.ground)
    down = -np.interp(time, *whole.lift)
    force = np.array([t.force for t in touches])
    on_wheelset = np.array([t.on_wheelset for t in touches])
    on_track = np.array([t.on_track for t in touches])

    def total(power):
        return [float(np.sum(0.5 * (power[1:] + power[:-1])) * FINE)]

    kept = {
        "bridge_displacement_m": x[:, 0],
        "bridge_velocity_m_s": v[:, 0],
        "hinge_rotation_rad": x[:, 1],
        "top_rotation_rad": x[:, 2],
        "base_moment_n_m": moment,
        "hinge_z_rad": hinge[:, 0],
        "hinge_energy_per_mass": hinge[:, 1],
        "hinge_largest_rotation_rad": np.maximum(hinge[:, 2], np.abs(x[:, 1])),
        "track_lateral_m": track[:, 0],
        "track_vertical_m": track[:, 1],
        "track_roll_rad": track[:, 2],
        "lateral_shift_m": np.array([t.place[0] for t in touches]),
        "wheelset_height_m": np.array([t.place[1] for t in touches]),
        "relative_roll_rad": np.array([t.place[2] for t in touches]),
        "wheel_load_left_n": -force[:, :2, 1].sum(1),
        "wheel_load_right_n": -force[:, 2:, 1].sum(1),
        "lateral_force_n": -force[:, :, 0].sum(1),
        "axle_rate_rad_s": turning[:, 0],
    }
    for k, body in enumerate(("car", "bogie", "wheelset")):
        for j, what in enumerate(("lateral_m", "vertical_m", "roll_rad")):
            kept[f"{body}_{what}"] = vehicle[:, 3 * k + j]
    kept = {name: values[::EVERY].tolist() for name, values in kept.items()}
    sideways = whole.mass * whole.sideways
    falling = whole.weight / 9.80665
    energies = {
        "ground": total(
            -whole.pier.mass * ground * v[:, 0]
            - ground * (speed @ sideways)
            - down * (speed @ falling)
        ),
        "gravity": total(speed @ whole.weight),
        "hinge": total(moment * v[:, 1]),
        "rayleigh": total(np.einsum("ti,ij,tj->t", v, whole.pier_c, v)),
        "dashpots": total(
            np.array([whole.car.at_work(*row)[1] for row in zip(vehicle, speed, strict=True)])
        ),
        "contact_vehicle": total(np.sum(on_wheelset * speed[:, -3:], axis=1)),
        "contact_track": total(np.sum(on_track * track_v, axis=1)),
        "impact": total(np.array([t.impact for t in touches])),
        "creep": total(np.array([t.tangential + t.spin + t.forward for t in touches])),
        "forward": total(np.array([t.forward for t in touches])),
        "spin": total(np.array([t.spin for t in touches])),
        "hertz": [touches[-1].stored - touches[0].stored],
    }
    return {**kept, **{f"energy: {name}": value for name, value in energies.items()}}


if __name__ == "__main__":
    from independent_model import solve
    from kalker import kalker_table

    reference = kalker_table(Path(sys.argv[1]))
    times = STORED["times"]
    found = {
        n: measured(*solve(jolt(n), reference, times, rtol=1e-8, push=push(n))[:3]) for n in JOLTS
    }
    rounded = json.dumps(found, default=float)
    rounded = json.loads(rounded, parse_float=lambda text: float(f"{float(text):.7g}"))
    FILE.write_text(json.dumps(rounded, indent=0).replace(",\n", ", ") + "\n", encoding="utf-8")
