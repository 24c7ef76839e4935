"""Plays one client against one board: run_client.py CLIENT BOARD [--variant NAME].

Variants: whole (default), bytes, bursts, garbage: how the client writes. reopen: the client goes and comes back to a
receiver that has kept its configuration. restart: a new process after the first, and the same dialogue again.
"""
import argparse
import pathlib
import sys
import time

import receiver
import wire
from clients import CLIENTS
from dialogue import Failure

VARIANTS = wire.WRITES + ("reopen", "restart")


def dialogue(kind, board, tty, writes):
    """One connection of the client, from its first speed to its last check."""
    line = wire.Wire(tty, writes=writes)
    client = kind(line, board)
    try:
        client.run()
        print(f"{client.name} on {board.name}: {client.items} items in {time.monotonic() - client.began:.1f} s")
    finally:
        line.close()
    return client


def play(kind, board, variant):
    writes = variant if variant in wire.WRITES else "whole"
    with receiver.open_folder() as folder:
        arguments = list(kind.arguments)
        if kind.orbits:
            arguments += ["--nav", receiver.SHARED / "nav" / kind.orbits, "--rebase-nav"]
        if kind.scenario:
            scenario = pathlib.Path(folder) / "scenario.toml"
            scenario.write_text(kind.scenario, encoding="utf-8")
            arguments.append(scenario)
        for _ in range(2 if variant == "restart" else 1):
            with receiver.start(board, folder, *arguments, moving="[trajectory]" in kind.scenario,
                                port=kind.laid_to) as emulator:
                try:
                    time.sleep(kind.after_power_on)
                    for _ in range(2 if variant == "reopen" else 1):
                        dialogue(kind, board, emulator.tty, writes)
                        time.sleep(0.5)
                finally:
                    code = emulator.stop()
                    print(emulator.log, file=sys.stderr)
                if code != 0:
                    raise Failure(f"skyloop ended {code}, expected 0: {emulator.log}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("client", choices=sorted(CLIENTS))
    parser.add_argument("board", choices=sorted(receiver.BOARDS))
    parser.add_argument("--variant", choices=VARIANTS, default="whole")
    options = parser.parse_args()
    wire.take_priority()
    if f"{options.board} " not in receiver.skyloop("boards").stdout:
        receiver.skip(f"this skyloop has no board {options.board}")
    orbits = CLIENTS[options.client].orbits
    if orbits and not (receiver.SHARED / "nav" / orbits).exists():
        receiver.skip(f"shared data absent: nav/{orbits}")
    try:
        play(CLIENTS[options.client], receiver.BOARDS[options.board], options.variant)
    except (Failure, ConnectionError) as error:
        print(f"FAILED: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
