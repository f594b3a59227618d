"""Runs: one by itself or many abreast, what they give and what is measured on them.

`simulate`   one scenario
`many`       any number, some abreast, on threads or on a GPU
`gpu`        lanes on a GPU
`time_step`  the time step chosen, not guessed
`response`   what a run gave
`assess`     its measures, one flat row
"""
