"""What a run is given: frozen, checked inputs in SI units that know nothing of their use.

`units`      quantities such as "80 km/h" to SI numbers, the only place that knows other units
`marks`      what else there is to a field: a file, one of several, a law of a family
`model`      what all models share: no unknown keys, one-line errors
`vehicle`    bodies, springs and dashpots, axles           Eq. 1
`support`    pier, ground, or a track of known motion      Eqs. 9, 10
`hinge`      the degrading pinched Bouc-Wen hinge          Eqs. 11, 12
`wheelrail`  profiles, material, friction, creep law       Eqs. 4 to 8
`profile`    cross-sections of wheels and rails            Eq. 4
`ground_motion`  records: readers, scaling, spectra
`motion`     which ground motion, and how much of it
`solver`     time step and methods
`toml`       case files as text
`layers`     presets below, a case's own values above, overrides on top
`identity`   what makes two scenarios the same
`scenario`   all of it together: case files and their checks
`fields`     inputs by their paths, as the axes of a study name them
`presets`    published parameter sets
`schema`     JSON Schema of a case file
"""
