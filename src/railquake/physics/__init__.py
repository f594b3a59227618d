"""The paper, one topic per file; every docstring gives its equation, units and source.

A *law* is a plain function of scalars.  A *stage* reads and writes named rows of the state
``S[row, lane]`` and of the constants ``Q[row, lane]`` and calls laws.  ``march.step`` strings the
stages together as Figure 4 of the paper does.  Nothing here is decorated: ``kernel.bind`` compiles
a set of these functions for a target, or leaves them as the plain Python that they are.
"""
