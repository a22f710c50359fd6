"""Computes a scenario's field at one time, writes it, and computes it again after an edit.

    python examples/field.py scenarios/jacksboro.yaml 49.5 field.vdb
"""

import sys

import numpy as np

import emscape as em


def main(file: str, time_s: float, volume: str) -> None:
    scenario = em.load(file)
    solver = em.Solver(scenario)
    field = solver.at(time_s)
    field.write(volume)

    # A view of the field's own memory: (z, y, x), x towards east.
    values = np.ma.masked_array(field.numpy(), field.mask())
    name = field.quantities[0]
    print(f"{name}: {values.min():.1f}..{values.max():.1f} {field.info()['unit']}, {field}")

    # What if the first emitter had 1 kW? Only what depends on it is computed again.
    power = f"emitters.{em.path_step(scenario.emitters[0])}.power_w"
    weaker = solver.at(time_s, scenario.with_set({power: 1000}))
    print(f"with 1 kW: mean change {np.mean(weaker.numpy() - field.numpy()):.2f} dB")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit("usage: python examples/field.py SCENARIO TIME_S VOLUME")
    main(sys.argv[1], float(sys.argv[2]), sys.argv[3])
