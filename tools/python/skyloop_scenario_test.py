#!/usr/bin/env python3
"""Runs one scenario for ctest: see tools/cmake/SkyloopScenarioTest.cmake. Exit code 0 when all expectations were met."""
import argparse
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

from skyloop_pytest import MET, ExpectationsNotMet, SkyloopRun, read_verdicts


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scenario", required=True)
    parser.add_argument("--folder", required=True, type=pathlib.Path, help="for the files of the run; it is emptied")
    parser.add_argument("--timeout", type=float, default=300, help="s")
    parser.add_argument("--options", default="", help="of skyloop, as a list of CMake")
    parser.add_argument("--client", nargs=argparse.REMAINDER, default=[])
    return parser.parse_args()


def end_group(process):
    """Ends the client with all that it started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait(20)


def run_beside_client(arguments, options):
    with SkyloopRun(arguments.scenario, arguments.folder, *options) as run:
        command = [part.replace("{port}", run.tty) for part in arguments.client]
        client = subprocess.Popen(command, env={**os.environ, "SKYLOOP_PORT": run.tty}, start_new_session=True)
        try:
            run.wait(arguments.timeout)
        except subprocess.TimeoutExpired:
            print(f"the run went on after {arguments.timeout:g} s; it was killed")
            return False
        finally:
            end_group(client)
        print(run.log, end="")
        try:
            run.check()
        except ExpectationsNotMet as not_met:
            print(not_met)
            return False
    return True


def run_alone(arguments, options):
    done = subprocess.run([arguments.program, "simulate", arguments.scenario, "--out", str(arguments.folder), *options],
                          stdin=subprocess.DEVNULL, timeout=arguments.timeout, check=False)
    for verdict in read_verdicts(arguments.folder / "junit.xml"):
        print(verdict)
    return done.returncode == MET


def main():
    arguments = read_arguments()
    shutil.rmtree(arguments.folder, ignore_errors=True)
    arguments.folder.parent.mkdir(parents=True, exist_ok=True)
    os.environ["SKYLOOP"] = arguments.program
    options = [option for option in arguments.options.split(";") if option]
    begin = time.monotonic()
    met = run_beside_client(arguments, options) if arguments.client else run_alone(arguments, options)
    print(f"{'met' if met else 'not met'} after {time.monotonic() - begin:.1f} s; files: {arguments.folder}")
    return 0 if met else 1


if __name__ == "__main__":
    sys.exit(main())
