"""Stages of the march by themselves, with the laws of a system in their slots."""

from railquake.march.compiler import PYTHON, bind
from railquake.march.slots import chosen, joining, solving


def stage(system, function, engine="alone"):
    """A stage, or several, as plain Python: what a run of the system calls.

    Of a slot it is what stands there.

    Parameters
    ----------
    system : railquake.assembly.system.System
    function : function
        Of `railquake.march` or `railquake.physics`, for example ``structure.move_structure``.
    engine : str
        ``"alone"``, ``"abreast"`` or ``"device"``, as in `slots.SLOTS`.
    """
    together = engine != "alone"
    linearised = together or system.scenario.solver.hinge_solve == "linearised"
    laws = chosen({**system.choices, "engine": engine})
    laws.update(joining(system.vehicle.joints.joined))
    laws.update(solving(system.structure.hinge, linearised, abreast=together))
    return bind(laws.get(function, function), PYTHON, laws, system.layout).call
