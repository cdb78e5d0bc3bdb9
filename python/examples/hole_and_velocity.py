"""Tells of each plate its verdict and hole, and of each body how fast it flies at the end.

Usage: `python hole_and_velocity.py RUN`
"""

import sys

import numpy as np

import whipple


def main(path):
    run = whipple.open(path)
    figures = run.figures
    print(f"{run.title}, at {figures.time[-1] * 1e6:.4g} µs")
    for measure in dict.fromkeys(run.measures.where(kind="plate").measure):
        hole = figures[f"{measure}.hole_diameter"][-1] * 1e3
        uncertainty = figures[f"{measure}.hole_diameter.uncertainty"][-1] * 1e3
        print(
            f"{measure}: {figures[f'{measure}.verdict'][-1]}, hole {hole:.3g} ± {uncertainty:.1g} mm"
        )

    whole = run.snapshots[-1].mirrored()
    start = run.snapshots[0].mirrored()
    for body in whole.body_names:
        velocities = [
            state.of(body).momentum() / state.of(body).total_mass() for state in (start, whole)
        ]
        first, last = (np.linalg.norm(velocity) for velocity in velocities)
        print(f"{body}: {first:.0f} m/s at the start, {last:.0f} m/s at the end")


if __name__ == "__main__":
    main(*sys.argv[1:])
