#!/usr/bin/env python3
"""Runs a program of bench/ that uses Google Benchmark, and compares the benchmarks of each group.

    bench/ratios.py PROGRAM [ARGUMENT...] [--to NAME] [--rounds 41] [--filter REGEX]

    bench/ratios.py build/release/bench/bendy_bench_open fox.bendy
    bench/ratios.py build/release/bench/bendy_bench fox.bendy --filter 'skin' --to 'skin positions'

All benchmarks run in one process, in random order in every round, so that other programs disturb all of them alike. Benchmarks
whose names are the same up to the last "/" form a group; each of them is compared with the one called NAME, or with the first.
The ratio is the median over the rounds of the ratio of processor times; least and median are times in microseconds.
"""

import argparse
import json
import statistics
import subprocess
import sys

MICROSECONDS = {'ns': 1e-3, 'us': 1.0, 'ms': 1e3, 's': 1e6}


def measure(command, rounds, wanted):
    """name -> processor time in microseconds, one for each round"""
    run = subprocess.run(
        [*command, '--benchmark_enable_random_interleaving=true', '--benchmark_repetitions=%d' % rounds,
         '--benchmark_min_time=0.002', '--benchmark_format=json', '--benchmark_filter=' + wanted],
        stdout=subprocess.PIPE, check=True)
    times = {}
    for entry in sorted(json.loads(run.stdout)['benchmarks'], key=lambda entry: entry['family_index']):  # as registered
        if entry['run_type'] == 'iteration':
            rounds_of = times.setdefault(entry['run_name'], {})
            rounds_of[entry['repetition_index']] = entry['cpu_time'] * MICROSECONDS[entry['time_unit']]
    return {name: [rounds_of[k] for k in sorted(rounds_of)] for name, rounds_of in times.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('program', nargs='+')
    parser.add_argument('--to', default='', help='the benchmark that the others of its group are compared with')
    parser.add_argument('--rounds', type=int, default=41)
    parser.add_argument('--filter', default='.')
    options = parser.parse_args()
    times = measure(options.program, options.rounds, options.filter)
    if not times:
        sys.exit('no benchmark has a name that fits ' + options.filter)
    groups = {}
    for name in times:
        groups.setdefault(name.rpartition('/')[0], []).append(name)
    print('| benchmark | least, us | median, us | ratio |\n|---|---|---|---|')
    for group, names in groups.items():
        base = times[next((name for name in names if name == group + '/' + options.to), names[0])]
        for name in names:
            own = times[name]
            ratio = statistics.median(one / other for one, other in zip(own, base))
            print('| %s | %.3g | %.3g | %.2f |' % (name, min(own), statistics.median(own), ratio))


if __name__ == '__main__':
    main()
