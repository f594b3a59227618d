"""Small studies for the tests of the report."""

from railquake.study import Study

# what a record's name may hold, and no page may take for its own
NASTY = '<img src=x onerror="document.title=1">%{x}$&</script>'
PIERS = {
    "coupled-elastic": {"support.coupled": True, "support.hinge": "elastic"},
    "coupled-nonlinear": {"support.coupled": True, "support.hinge": "bouc-wen"},
    "decoupled-elastic": {"support.coupled": False, "support.hinge": "elastic"},
    "decoupled-nonlinear": {"support.coupled": False, "support.hinge": "bouc-wen"},
    "at-grade": {"support.kind": "at-grade"},
}


def study(models=tuple(PIERS), *, dt=3e-5, levels=None, members=6, axes=None):
    """A study on motions of 5 s."""
    from railquake.suite import Suite, SuiteMember

    motions = tuple(
        SuiteMember(
            NASTY if k == 0 else f"motion {k}",
            {"synthetic": {"seed": k, "duration": 5.0, "pga": 8.0}},
            1.0,
        )
        for k in range(members)
    )
    return Study(
        base={
            "vehicle": {"preset": "bart", "speed": "80 km/h"},
            "support": {"preset": "bart-berkeley"},
            "wheelrail": {"preset": "bart"},
            "solver": {"dt": dt},
        },
        suite=Suite("six short ones", motions),
        levels={"10%": 0.7, "2%": 1.6} if levels is None else levels,
        axes=axes
        if axes is not None
        else {"model": [{"name": name, "set": PIERS[name]} for name in models]},
    )
