"""How a train derailed, from when each of its events first held."""

import numpy as np
import pytest

from railquake.march.rows import USUAL, state
from railquake.physics.derailment import CLIMB, OVERTURNED, SLIDE_OFF
from railquake.run.verdict import Ending, derailment_mode


@pytest.mark.parametrize(
    ("times", "mode"),
    [
        ({}, None),
        ({SLIDE_OFF: 2.0}, "slide-off left"),
        ({OVERTURNED: 2.0, SLIDE_OFF: 2.2}, "overturned left"),
        ({SLIDE_OFF: 2.0, OVERTURNED: 2.5}, "combined left"),
        ({SLIDE_OFF: 2.0, OVERTURNED: 2.6}, "slide-off left"),
        # within one and the same frame
        ({SLIDE_OFF: 2.0, OVERTURNED: 2.0}, "combined left"),
        ({CLIMB: 2.0, SLIDE_OFF: 2.4, OVERTURNED: 2.4}, "combined left"),
    ],
)
def test_mode_follows_from_which_came_first_and_what_within_half_a_second(times, mode):
    end = np.zeros((USUAL.size.STATE_ROWS, 1))
    end[USUAL.state_blocks["FIRST_TIME"]] = -1.0
    for event, time in times.items():
        end[state.FIRST_TIME + event] = time
    end[USUAL.state_blocks["FIRST_SIDE"]] = -1.0
    assert derailment_mode(Ending(end, USUAL.state)) == mode
