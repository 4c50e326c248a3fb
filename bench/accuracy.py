#!/usr/bin/python3
"""Whether `mortier run --accuracy` keeps what it says, against far better solutions of the same scenes.

    bench/accuracy.py [PART ...] [--times 0.5] [--finer 6] [--degree 2]
    bench/accuracy.py --orders
    bench/accuracy.py --random FROM TO [--first N]

Each scene is solved for an accuracy, and for one that is --finer times better: the true error is the
difference of the stresses at the end of the run, in the energy norm. A row per scene: unknowns, true error
over what was asked, estimate over true error, work of all rounds over the last one's (unknowns to the power
1.2, times steps). With words, only scenes whose names have one. --orders: a thick cylinder of which a part
flows, on equal cells, by degree: order in unknowns, and what 1e-3 takes. --random: problems whose data,
materials and first meshes are drawn; a row per seed, which is the same on every machine. With --first each is
solved from N first meshes: unknowns over those of the best one.
"""
import argparse
import statistics
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "compare"))
from accuracies import (cases, first_meshes, fitted, flow_orders, measured,  # noqa: E402
                        random_case)
import results  # noqa: E402


def orders():
    found = flow_orders({1: [4, 8, 16, 32], 2: [2, 4, 8, 16]}, 40)
    takes = {}
    for degree, (unknowns, errors) in found.items():
        order, unknowns_of = fitted(unknowns, errors)
        takes[degree] = unknowns_of(1e-3)
        rows = ", ".join(f"{n} {error:.2e}" for n, error in zip(unknowns, errors))
        print(f"degree {degree}: order {order:.2f} in unknowns, "
              f"{takes[degree]:.3g} unknowns for 1e-3 ({rows})")
    print(f"degree 1 over degree 2 at 1e-3: {takes[1] / takes[2]:.0f}")


def rows_of_random(first, last, finer, meshes):
    print(f"{'seed':>5} {'asked':>8} {'unknowns':>9} {'error/asked':>12} {'estimate/error':>15} "
          f"{'overhead':>9}")
    errors, luck = [], []
    for seed in range(first, last):
        scene, bodies, accuracy, degree = random_case(seed)
        if meshes:
            least, most = first_meshes(seed, meshes)
            luck.append(most / least)
            print(f"{seed:5} {accuracy:8.3g} {least:9} to {most}: {luck[-1]:.2f}", flush=True)
            continue
        try:
            unknowns, error, estimate, overhead, reached = measured(scene, bodies, accuracy, degree, finer)
        except results.ResultError as failure:
            print(f"{seed:5} {accuracy:8.3g} no result: {failure}", flush=True)
            continue
        if reached:
            errors.append(error / accuracy)
        print(f"{seed:5} {accuracy:8.3g} {unknowns:9} {error / accuracy:12.3g} {estimate / error:15.2f} "
              f"{overhead:9.2f}{'' if reached else '  not reached'}", flush=True)
    if meshes:
        print(f"{len(luck)} problems, {sum(each <= 1.5 for each in luck)} within 1.5, worst {max(luck):.2f}")
    else:
        print(f"{len(errors)} reached, {sum(each <= 1 for each in errors)} below what was asked, worst "
              f"{max(errors):.2f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("parts", nargs="*")
    parser.add_argument("--finer", type=float, default=6)
    parser.add_argument("--times", type=float, default=1,
                        help="what the accuracies of the scenes are multiplied by")
    parser.add_argument("--degree", type=int, default=2)
    parser.add_argument("--orders", action="store_true")
    parser.add_argument("--random", nargs=2, type=int, metavar=("FROM", "TO"))
    parser.add_argument("--first", type=int, default=0)
    options = parser.parse_args()
    if options.random:
        rows_of_random(*options.random, options.finer, options.first)
        return
    if options.orders:
        orders()
        return
    print(f"{'':<36} {'asked':>8} {'unknowns':>9} {'error/asked':>12} {'estimate/error':>15} {'overhead':>9}")
    rows = []
    for name, (scene, bodies, accuracy) in cases().items():
        if options.parts and not any(part in name for part in options.parts):
            continue
        accuracy *= options.times
        unknowns, error, estimate, overhead, reached = measured(scene, bodies, accuracy, options.degree,
                                                                options.finer)
        rows.append((error / accuracy, estimate / error, overhead, reached))
        print(f"{name:<36} {accuracy:8.3g} {unknowns:9} {error / accuracy:12.3g} {estimate / error:15.2f} "
              f"{overhead:9.2f}{'' if reached else '  not reached'}", flush=True)
    below = sum(row[0] <= 1 and row[3] for row in rows)
    ratios, overheads = [row[1] for row in rows], [row[2] for row in rows]
    print(f"{len(rows)} cases, {below} below what was asked; estimate over true error {min(ratios):.2f} to "
          f"{max(ratios):.2f}, {sum(0.9 <= ratio <= 1.3 for ratio in ratios)} within 0.9 and 1.3; "
          f"overhead: median {statistics.median(overheads):.2f}, worst {max(overheads):.2f}")


if __name__ == "__main__":
    main()
