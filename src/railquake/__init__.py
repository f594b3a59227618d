"""How safely a train runs over a bridge in an earthquake.

>>> import railquake as rq
>>> case = rq.scenario(record="RSN181.AT2", scale=1.81)
>>> response = rq.simulate(case)
>>> rq.assess(response)["uplift_ratio"]
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from railquake.version import __version__

if TYPE_CHECKING:
    from railquake.assembly import assemble as assemble
    from railquake.errors import InputError as InputError
    from railquake.fragility import Fragility as Fragility
    from railquake.inputs.ground_motion import GroundMotion as GroundMotion
    from railquake.inputs.ground_motion import read_motion as read_motion
    from railquake.inputs.scenario import Scenario as Scenario
    from railquake.inputs.scenario import load_scenario as load_scenario
    from railquake.inputs.scenario import scenario as scenario
    from railquake.run.assess import assess as assess
    from railquake.run.many import simulate_many as simulate_many
    from railquake.run.response import Response as Response
    from railquake.run.simulate import simulate as simulate
    from railquake.study import Study as Study
    from railquake.study import load_study as load_study

# Loaded when first asked for: `import railquake` stays quick.
_HOMES = {
    "Fragility": "railquake.fragility",
    "GroundMotion": "railquake.inputs.ground_motion",
    "InputError": "railquake.errors",
    "Response": "railquake.run.response",
    "Scenario": "railquake.inputs.scenario",
    "Study": "railquake.study",
    "assemble": "railquake.assembly",
    "assess": "railquake.run.assess",
    "load_scenario": "railquake.inputs.scenario",
    "load_study": "railquake.study",
    "read_motion": "railquake.inputs.ground_motion",
    "scenario": "railquake.inputs.scenario",
    "simulate": "railquake.run.simulate",
    "simulate_many": "railquake.run.many",
}

__all__ = ["__version__", *_HOMES]


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        value = getattr(import_module(_HOMES[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'railquake' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
