#!/usr/bin/env python3
"""Runs a program on a folder of scenes, has every trace graded by the drop-in oracle, and counts.

    integrations/course/run_tests.py --program ./FOSSSim --oracle ./FOSSSimOracle scenes/

The oracle is any program with the original's command line: fosssim-oracle called through a link whose name starts with
FOSSSimOracle is one. This script trusts the program it runs; `fosssim-oracle grade` does not.
"""
import argparse
import os
import pathlib
import subprocess
import sys
import tempfile


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="the program to grade")
    parser.add_argument("--oracle", required=True, help="the oracle")
    parser.add_argument("--seconds", type=float, default=60, help="time for one run")
    parser.add_argument("scenes", type=pathlib.Path, help="a folder of scenes")
    arguments = parser.parse_args()
    program, oracle = (str(pathlib.Path(path).absolute()) for path in (arguments.program, arguments.oracle))
    for what, path in (("program", program), ("oracle", oracle)):
        if not os.path.isfile(path):
            parser.exit(2, f"there is no {what} at {path}; build it first, or name another with --{what}\n")
        if not os.access(path, os.X_OK):
            parser.exit(2, f"the {what} {path} can't be run; is it the built program (chmod +x)?\n")
    scenes = sorted(arguments.scenes.rglob("*.xml"))
    if not scenes:
        parser.error(f"no scene below {arguments.scenes}")
    passed, failed = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            try:
                verdict = grade(program, oracle, str(scene.absolute()), folder, arguments.seconds)
            except OSError as error:
                # Such as a program for another machine: it is the same for every scene.
                parser.exit(2, f"{error.filename} can't be run: {error.strerror}\n")
            print(f"{scene.relative_to(arguments.scenes)}: {verdict}")
            passed += verdict == "Passed."
            failed += verdict != "Passed."
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


def grade(program, oracle, scene, folder, seconds):
    """The oracle's overall verdict, or why there is none."""
    trace = pathlib.Path(folder, "trace.bin")
    trace.unlink(missing_ok=True)
    try:
        run = [program, "-s", scene, "-d", "0", "-o", str(trace)]
        subprocess.run(run, cwd=folder, timeout=seconds, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        judge = [oracle, "-s", scene, "-d", "0", "-i", str(trace)]
        output = subprocess.run(judge, cwd=folder, timeout=seconds, capture_output=True).stdout.decode(errors="replace")
    except subprocess.TimeoutExpired as late:
        return f"no verdict: {pathlib.Path(late.cmd[0]).name} took more than {seconds:g} seconds"
    for line in output.splitlines():
        if line.startswith("Overall success: "):
            return line.removeprefix("Overall success: ")
    return "no verdict"


if __name__ == "__main__":
    sys.exit(main())
