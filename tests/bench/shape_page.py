# SPDX-License-Identifier: Apache-2.0
"""The rows of docs/benchmarks.md about the parts of the papers."""

from measure import Figures

#: What the papers say of the same part: seconds, errors in mm.
PAPERS = {
    "reference-inch": "S0: 1,200 s, mean error 0.076 mm",
    "reference-mm": "S0: 1,320 s, mean error 0.319 mm",
    "pawn": "S1: 227 s, largest error 0.10 mm",
}


def shape_rows(found: Figures) -> list[tuple[str, str, str]]:
    """One row a part: time, estimate, lower bound, errors, gouge."""
    return [
        (
            f"{name}: {one['seconds']:.0f} s, planned {one['estimate_s']:.0f} s, "
            f"length of cut by feed {one['least_s']:.0f} s",
            f"mean error {one['mean_error_mm']:.4f} mm, largest {one['max_error_mm']:.4f} mm; "
            f"gouge {one['gouge_steps']:.2f} steps, left {one['left_steps']:.2f}, "
            f"crashes {one['crashes']}",
            PAPERS.get(name, ""),
        )
        for name, one in found["shapes"].items()
    ]
