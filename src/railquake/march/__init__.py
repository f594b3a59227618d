"""Figure 4: how a run is marched in time.

The only rooms that know the rows ``S[row, lane]`` and ``Q[row, lane]``.  A *stage* loads rows,
calls a law of `railquake.physics` and stores what it gives.

`rows_state`, `rows_constant`  every row, declared once
`rows`                         where each stands, for the sizes of a run
`packing`, `packed`, `order`   how named tuples, matrices and the vehicle's degrees are kept in rows
`slots`                        what may be swapped, and what may stand there
`ground`, `structure`, `track`, `sprung`, `wheelset`, `contact`, `peaks`, `events`   the stages
`step`                         Figure 4
`frames`                       frames, for one scenario, many abreast, or a thread each on a GPU
`compiler`                     an entry function with the chosen laws, for a target
"""
