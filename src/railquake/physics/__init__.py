"""The paper, one topic per file; every docstring gives its equation, units and source.

A *law* is a plain function of scalars and named tuples.  Nothing here is decorated and nothing
knows how a run keeps its numbers: the march (`railquake.march`) loads, calls and stores.

`vehicle`        bodies and their equations of motion                   Eq. 1
`suspension`     springs and dashpots between them                      Eq. 1
`zhai`           the vehicle's integrator                               Eqs. 2, 3
`profiles`       where wheel and rail touch, by the grid method         Eq. 4
`contact_table`  its results in a table
`hertz`          stiffness of the contact                               Eq. 6
`impact`         normal force and loss at impacts, a file a law         Eqs. 5, 7
`creep`          tangential force, a file a law                         Eq. 8
`axle`           longitudinal slip, and the axle that turns
`patch`          one patch: all of it together                          Eqs. 4 to 8
`pier`           the column                                             Eqs. 9, 10
`newmark`        its integrator
`hinge`          the plastic hinge, a file a law                        Eqs. 11, 12
`track`          the track on the pier, the wheelset on the track
`derailment`     what counts as uplift, onset, derailed
`energy`         two balances that must close
`low_pass`       short impacts out of forces                            Figure 10
`elementary`     elementary functions that a vector unit can do
"""
