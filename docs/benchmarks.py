#!/usr/bin/env python3
"""Writes docs/benchmarks.md, its plots and pictures, and the table of README.md from what softshadow-bench measured.

JSON files of one device are put together; those of several devices get sections of their own, in the order given. Plots
and pictures are taken from the folders `plots` and `images` beside a JSON file; where there are none, those in
docs/images/benchmarks stay. The prose is docs/report/benchmarks.in.md. Pictures need oiiotool.
"""
import argparse
import pathlib
import sys

sys.dont_write_bytecode = True  # nothing but documents is left in the source tree
from report import document, pictures, rows  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("json", nargs="+", type=pathlib.Path, help="of softshadow-bench --json")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT, metavar="DIR",
                        help="write DIR/README.md and DIR/docs in place of this repository's")
    options = parser.parse_args()
    try:
        devices = rows.load(options.json)
        pictures.update(devices, options.out / "docs/images/benchmarks")
        document.write(devices, ROOT, options.out)
    except (OSError, rows.Unusable) as error:
        sys.exit(f"benchmarks.py: {error}")
    print(f"{options.out}: README.md and docs/benchmarks.md have the new figures")


if __name__ == "__main__":
    main()
