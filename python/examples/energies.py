"""Draws the energies of a run over time, and how well their sum is kept; needs matplotlib.

Usage: `python energies.py RUN [PICTURE]`
"""

import sys

import matplotlib.pyplot as plt

import whipple


def main(path, picture="energies.png"):
    run = whipple.open(path)
    history = run.history
    time = history.time * 1e6
    figure, axes = plt.subplots(layout="constrained")
    for name in ("kinetic_energy", "internal_energy", "contact_energy", "total_energy"):
        axes.plot(time, history[name], label=name.replace("_", " "))
    axes.set(xlabel="time (µs)", ylabel=f"energy ({history.unit('total_energy')})", title=run.title)
    axes.legend()
    figure.savefig(picture, dpi=150)
    change = abs(history.total_energy - history.total_energy[0]).max()
    print(f"{picture}: total energy changes by {change / history.total_energy[0]:.2%} at most")


if __name__ == "__main__":
    main(*sys.argv[1:])
