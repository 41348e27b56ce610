# SPDX-License-Identifier: Apache-2.0
"""Turn the outline of a turned part in a DXF drawing into a part file.

`drawing.py` reads entities, `section.py` finds the axis and the half to use, `chain.py` joins
pieces to one chain, `contour.py` makes it a profile from the free end to the chuck,
`part_text.py` writes the part file, `picture.py` shows the place of a problem.
ezdxf is imported by `drawing.py` and `approximation.py` alone, when they run.
"""
