#!/usr/bin/env python3
"""Drives a deck in a running daemon: `overclosure serve`, then this. Needs the Python client: pip install ./clients/python"""

import argparse
from pathlib import Path

import overclosure

DECK = Path(__file__).resolve().parent / "two_blocks.inp"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--endpoint", default="tcp/127.0.0.1:7447", help="of the daemon [%(default)s]")
    options = parser.parse_args()
    with overclosure.connect(options.endpoint) as client, client.open(DECK) as session:
        before = session.checkpoint()
        for i in range(1, 5):
            step = session.step(i / 4, inputs={"boundary.NTOP.3": -0.005 * i})
            print(f"time {step.time:4.2f}  force {step.outputs['contact.SSL_SMA.CFN3']:9.5f}")
        pressure = session.field("CPRESS")
        for label, value in zip(pressure.labels, pressure.values, strict=True):
            print(f"node {label}  CPRESS {value:.6f}")
        session.restore(before)
        print(f"back at time {session.time}")


if __name__ == "__main__":
    main()
