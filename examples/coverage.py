"""Where a radar detects a low target, with and without a jammer, and why it does not at one position.

    python examples/coverage.py
"""

import numpy as np

import emscape as em


def main() -> None:
    scenario = em.load("scenarios/jamming.yaml")
    silent = scenario.with_set({"emitters.stand-off jammer.active_s": [[0, 1]]})
    for name, variant in (("with the jammer", scenario), ("without it", silent)):
        covered = em.coverage(variant, heights="agl:150", product="covered", times=40, cell_m=500)
        print(f"{name}: {float(covered.sum()) * 0.25:.0f} km2 of {int(np.isfinite(covered).sum()) * 0.25:.0f} km2")

    path = em.profile(scenario, emitter="search radar", to=(36.35, -84.20, 150), agl=True, time_s=40)
    print(path["verdict"])


if __name__ == "__main__":
    main()
