"""Vehicles: the shipped cars' modes, and what is refused."""

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.identity import fingerprint
from railquake.inputs.presets import preset_names
from railquake.inputs.vehicle import Body, Dashpot, Spring, Vehicle


def frequencies(vehicle: Vehicle) -> np.ndarray:
    """Frequencies [Hz] with the wheelset held, from M and K put together here, apart from the
    package: point displacement (dy - pz phi, dz + py phi), y right, z down, phi right side down."""
    bodies = [body for body in vehicle.bodies if body.name != vehicle.wheelset]
    index = {body.name: 3 * i for i, body in enumerate(bodies)}
    height = {body.name: body.height for body in vehicle.bodies}
    mass = np.diag([m for b in bodies for m in (b.mass, b.mass, b.roll_inertia)])
    stiffness = np.zeros_like(mass)
    for spring in vehicle.springs:
        for side in (1.0, -1.0) if spring.pair else (1.0,):
            row = np.zeros(len(mass))
            ends = zip(spring.bodies, spring.end_heights, (-1.0, 1.0), strict=True)
            for name, end_height, sign in ends:
                if name not in index:
                    continue
                py, pz = side * spring.lateral, height[name] - end_height
                shape = (1, 0, -pz) if spring.direction == "lateral" else (0, 1, py)
                row[index[name] : index[name] + 3] += sign * np.array(shape)
            stiffness += spring.stiffness * np.outer(row, row)
    scale = 1.0 / np.sqrt(np.diag(mass))
    eigenvalues = np.linalg.eigvalsh(stiffness * np.outer(scale, scale))
    return np.sqrt(eigenvalues) / (2.0 * np.pi)


def test_bart_recovers_table_1_of_the_paper():
    expected = [0.292, 1.009, 1.034, 2.578, 4.453, 4.791]
    np.testing.assert_allclose(frequencies(Vehicle.from_preset("bart")), expected, rtol=2e-3)


def test_bart_2023_runs_recovers_the_authors_frequencies():
    expected = [0.316, 1.142, 1.252, 2.649, 5.390, 7.356]
    found = frequencies(Vehicle.from_preset("bart-2023-runs"))
    np.testing.assert_allclose(found, expected, rtol=2e-3)


def test_bart_geometry():
    car, bogie, wheelset = Vehicle.from_preset("bart").bodies
    assert (car.mass, bogie.mass, wheelset.mass) == (29600.0, 7242.0, 2592.0)
    heights = (wheelset.height, bogie.height, car.height)
    assert heights == pytest.approx((0.392, 0.417, 2.043), abs=5e-4)
    assert Vehicle.from_preset("bart").mass == 39434.0


def test_bart_2023_runs_geometry():
    vehicle = Vehicle.from_preset("bart-2023-runs")
    car, bogie, wheelset = vehicle.bodies
    heights = (wheelset.height, bogie.height, car.height)
    assert heights == pytest.approx((0.392, 0.519, 2.221), abs=5e-4)
    secondary = next(d for d in vehicle.dashpots if d.name == "secondary-lateral")
    arms = (car.height - secondary.end_heights[0], secondary.end_heights[1] - bogie.height)
    assert arms == pytest.approx((50 * 0.0254, 15 * 0.0254))
    assert vehicle.axles == 1
    assert wheelset.roll_inertia == pytest.approx(8 * 362.41)


BODIES = [
    Body(name="car", mass="20 t", roll_inertia=3e4, height="2 m"),
    Body(name="wheelset", mass=2000, roll_inertia=1e3, height="0.4 m"),
]
JOINT = {"bodies": ["car", "wheelset"], "stiffness": "1 MN/m", "lateral": 0.5, "height": 1.0}
SPRINGS = [
    Spring(name="lateral", direction="lateral", **JOINT),
    Spring(name="vertical", direction="vertical", **JOINT),
]


def small_vehicle(**changes: object) -> Vehicle:
    values = {"name": "x", "bodies": BODIES, "springs": SPRINGS, "axles": 2, "speed": "80 km/h"}
    return Vehicle(**(values | changes))


def test_a_vehicle_of_two_bodies():
    vehicle = small_vehicle()
    assert vehicle.speed == pytest.approx(80 / 3.6)
    assert vehicle.bodies[0].mass == 20000.0
    assert vehicle.springs[0].end_heights == (1.0, 1.0)


def test_a_wheelset_alone_is_a_vehicle():
    assert len(small_vehicle(bodies=BODIES[1:], springs=[]).bodies) == 1


def test_bodies_may_be_written_as_tables_by_name():
    table = {body.name: body.model_dump(exclude={"name"}) for body in BODIES}
    assert small_vehicle(bodies=table) == small_vehicle()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bodies": BODIES + BODIES[:1]}, ["bodies", '"car" is used twice']),
        ({"springs": SPRINGS + SPRINGS[:1]}, ["springs", "used twice"]),
        ({"wheelset": "weelset"}, ["wheelset", 'did you mean "wheelset"']),
        ({"springs": SPRINGS[:1]}, ["bodies.car", "vertical springs"]),
        ({"axles": 0}, ["axles", "at least 1"]),
        ({"axles": 2.0}, ["axles", "whole number"]),
        ({"speed": "80 km"}, ["speed", "(a length)", "80 km/h"]),
        ({"speed": -1.0}, ["speed", "zero or positive"]),
        ({"bodies": []}, ["bodies", "at least 1"]),
        ({"bodies": "car"}, ["bodies", "must be a list"]),
        ({"bodies": {"car": 3}}, ["bodies.car", "must be a table"]),
        ({"wheels": 4}, ["wheels", "unknown key"]),
    ],
)
def test_vehicles_that_make_no_sense(changes, words):
    with pytest.raises(InputError) as caught:
        small_vehicle(**changes)
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bodies": ["car", "bogie"]}, ["springs.x.bodies", 'no body is called "bogie"']),
        ({"bodies": ["car", "car"]}, ["springs.x.bodies", "itself"]),
        ({"stiffness": 0.0}, ["springs.x.stiffness", "positive"]),
        ({"stiffness": "3 m"}, ["springs.x.stiffness", "(a length)"]),
        ({"heights": [1.0, 1.1]}, ["springs.x", "found both"]),
        ({"height": None}, ["springs.x", "found neither"]),
        ({"direction": "up"}, ["springs.x.direction", '"lateral" or "vertical"']),
        ({"pair": "yes"}, ["springs.x.pair", "true or false"]),
    ],
)
def test_springs_that_make_no_sense(changes, words):
    spring = {"name": "x", "direction": "lateral", **JOINT, **changes}
    with pytest.raises(InputError) as caught:
        small_vehicle(springs=[*SPRINGS, spring])
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize("mass", [0.0, -1.0, float("nan"), float("inf"), "3 m", "3", None])
def test_bodies_without_a_real_mass(mass):
    with pytest.raises(InputError, match=r"^Body: mass: must be"):
        Body(name="car", mass=mass, roll_inertia=1.0, height=1.0)


def test_a_dashpot_may_have_no_damping_but_none_below():
    values = {**JOINT, "name": "d", "direction": "lateral"}
    del values["stiffness"]
    assert Dashpot(**values, damping=0).damping == 0.0
    with pytest.raises(InputError, match="damping"):
        Dashpot(**values, damping=-1)


def test_inputs_are_frozen():
    with pytest.raises(ValueError, match="frozen"):
        BODIES[0].mass = 1.0


# --- stops, anti-roll bars, kinematics ----------------------------------------------------------

STOP = {"bodies": ["car", "bogie"], "direction": "lateral", "lateral": 0.0, "height": 0.77}
GAP = {"gap": 0.03, "stiffness": 1e6}


def with_stop(**values):
    return Vehicle.from_preset("bart-under-gravity", {"stops": {"own": {**STOP, **values}}})


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"travel": [0.0, 0.02, 0.03], "force": [0.0, 900.0, 800.0]}, "must not fall: 900 N, then"),
        ({"travel": [0.01, 0.02], "force": [0.0, 900.0]}, "must begin with no force at no travel"),
        ({"travel": [0.0, 0.02], "force": [5.0, 900.0]}, "found 5 N at 0 m"),
        ({"travel": [0.0, 0.02, 0.02], "force": [0.0, 1.0, 2.0]}, "must rise, found 0.02 m, then"),
        ({"travel": [0.0, 0.02], "force": [0.0]}, r"needs as many values as travel \(2\), found 1"),
        ({"travel": [0.0, 0.02, 0.03], "force": [0.0, 5.0, 5.0]}, "must rise at its end"),
        ({}, "give either gap and stiffness, or travel and force; found neither"),
        ({"gap": 0.03}, "stiffness: is needed beside gap"),
        ({**GAP, "bodies": ["car", "car"]}, 'joins "car" to itself'),
        ({**GAP, "bodies": ["car", "bogey"]}, 'did you mean "bogie"'),
        ({**GAP, "height": 0.2}, "0.2 m lies below the axle, which is 0.391899 m above the rails"),
    ],
)
def test_a_stop_that_makes_no_sense_is_refused_with_its_field(values, message):
    with pytest.raises(InputError, match=message) as refused:
        with_stop(**values)
    assert "stops.own" in str(refused.value) and "\n" not in str(refused.value)


def test_a_stop_is_a_gap_or_a_table_and_factors_stretch_it():
    assert with_stop(**GAP).stops[-1].force_over_travel == ((0.0, 0.03, 1.03), (0.0, 0.0, 1e6))
    stretched = with_stop(
        travel=[0.0, 0.02, 0.03], force=[0.0, 100.0, 300.0], travel_factor=2.0, force_factor=0.5
    ).stops[-1]
    assert stretched.force_over_travel == ((0.0, 0.04, 0.06), (0.0, 50.0, 150.0))
    assert stretched.longest == 0.06
    assert with_stop(**GAP).stops[-1].longest is None


@pytest.mark.parametrize("bodies", [["car", "car"], ["car", "roof"]])
def test_an_anti_roll_bar_between_one_body_is_refused(bodies):
    bar = {"bodies": bodies, "stiffness": 1e6}
    with pytest.raises(InputError, match="anti_roll_bars.bar.bodies"):
        Vehicle.from_preset("bart", {"anti_roll_bars": {"bar": bar}})


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ({"stops": {"own": {**STOP, **GAP}}}, "stops.own: is a stop, which no linear car can have"),
        (
            {"dashpots": {"primary-lateral": {"knee": "0.1 m/s", "damping_beyond": 1e3}}},
            "primary-lateral: has a knee, which no linear car can have",
        ),
    ],
)
def test_a_linear_car_has_no_stops_and_no_knees(what, message):
    with pytest.raises(InputError, match=message):
        Vehicle.from_preset("bart", what)


def test_the_papers_cars_are_linear_and_others_are_not():
    kinds = {name: Vehicle.from_preset(name).kinematics for name in preset_names("vehicle")}
    linear = [name for name, kind in kinds.items() if kind == "linear"]
    assert sorted(linear) == ["bart", "bart-2023-runs"]


@pytest.mark.parametrize("name", ["crh380a", "hsr-generic", "ice3-motor", "manchester"])
def test_a_published_car_says_where_it_is_from_and_how_far_to_trust_it(name):
    vehicle = Vehicle.from_preset(name)
    assert len(vehicle.source) > 40 and "Read in" in vehicle.note


def test_a_linear_car_without_stops_is_told_apart_as_before_there_was_a_choice():
    """Rows of older studies stay theirs; what is chosen is told apart."""
    before = fingerprint(Vehicle.from_preset("bart"))
    for new in ("kinematics", "stops", "anti_roll_bars", "knee", "damping_beyond"):
        assert new not in before
    knee = {"kinematics": "finite", "dashpots": {"primary-lateral": {"knee": "0.1 m/s"}}}
    for changes in ({"kinematics": "finite"}, knee):
        after = fingerprint(Vehicle.from_preset("bart", changes))
        assert after != before and '"kinematics":"finite"' in after
    assert '"knee":0.1' in fingerprint(Vehicle.from_preset("bart", knee))
