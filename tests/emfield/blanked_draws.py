#!/usr/bin/env python3
"""Draws for the table of side_lobe_blanking_test.cpp: a radar's pulses behind a side-lobe blanker.

Per pulse the jammers' fields g (complex Gaussian, on for the part `duty` of the pulses) add up in the main
channel with the powers `main`, in the auxiliary one, over the threshold, with the powers `auxiliary` and
arbitrary phases; the main channel adds noise of the power 1 and the echo. A pulse is blanked if the auxiliary
channel is the stronger. The powers of the K open pulses of a look are summed; a detection is a sum above
the threshold of K pulses of noise for a probability of false alarm of 1e-6, times the mean power of the open
pulses without an echo. Takes minutes; needs numpy and scipy.
"""
import numpy as np
from scipy.special import gammainccinv

SETS = [  # main, auxiliary, duty of each jammer
    [(3.162, 10, 1)],
    [(100, 100, 1)],
    [(50, 158, 1)] * 2,
    [(100, 1000, 1)] * 3,
    [(15, 300, 1), (30, 200, 1), (10, 60, 1), (2.5, 100, 1)],
    [(100, 316, 0.3)],
    [(3.162, 10, 0.6)],
    [(10, 100, 1), (100, 1000, 0.9)],
    [(126, 190, 0.3)],
    [(100, 1000, 0.5)] * 2,
]
PULSES = (1, 4, 16, 64)


def probabilities(jammers, pulses, swerling, snrs_db, looks, random):
    shape = (looks, pulses)

    def gaussian():
        return (random.standard_normal(shape) + 1j * random.standard_normal(shape)) * 0.5**0.5

    def phases():
        return np.exp(2j * np.pi * random.random(shape))

    main, auxiliary = gaussian(), np.zeros(shape, complex)
    for power, other, duty in jammers:
        field = gaussian() * (random.random(shape) < duty)
        main += power**0.5 * field
        auxiliary += other**0.5 * field * phases()
    echo = {
        0: lambda: np.ones((looks, 1)),
        1: lambda: random.exponential(size=(looks, 1)),
        2: lambda: random.exponential(size=shape),
        3: lambda: random.gamma(2, 0.5, size=(looks, 1)),
        4: lambda: random.gamma(2, 0.5, size=shape),
    }[swerling]() ** 0.5 * phases()
    thresholds = np.array([np.inf] + [gammainccinv(k, 1e-6) for k in range(1, pulses + 1)])
    opens = np.abs(auxiliary) <= np.abs(main)
    noise = (np.abs(main) ** 2)[opens].mean()
    for snr_db in snrs_db:
        received = np.abs(main + 10 ** (snr_db / 20) * echo)
        opens = np.abs(auxiliary) <= received
        detected = (received**2 * opens).sum(1) > thresholds[opens.sum(1)] * noise
        yield detected.mean()


def main():
    random = np.random.default_rng(3)
    for number, jammers in enumerate(SETS):
        for pulses in PULSES:
            for swerling in range(5):
                levels = range(0, 46, 3)
                found = list(probabilities(jammers, pulses, swerling, levels, 1000, random))
                level = min(zip(levels, found), key=lambda pair: abs(pair[1] - 0.6))[0]
                looks = max(20000, 100000 // pulses)
                (exact,) = probabilities(jammers, pulses, swerling, [level], looks, random)
                print(f"{{{number}, {pulses}, {swerling}, {level}, {exact:.3f}}},", end=" ", flush=True)
        print()


if __name__ == "__main__":
    main()
