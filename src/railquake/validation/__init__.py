"""The model held against references that it did not write: ``railquake validate``.

A module for each comparison, with its source, what is compared and why its tolerance; see
`railquake.validation.comparison` for their form and `railquake.validation.registry` for the list.
Reference numbers lie beside the modules, or in a folder of reference data.
"""
