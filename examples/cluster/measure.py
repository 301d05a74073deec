#!/usr/bin/env python3
"""Measures what HyperQueue costs, and that nothing is lost when processes die.

    examples/cluster/measure.py CONFIG FOLDER [--workers 4] [--kill-every 20]

Works the exam of CONFIG off by plain processes, one a case, one after another; then by HyperQueue
while one process of a task is killed with signal 9 every so many seconds; compares the bytes.
"""

import argparse
import os
import pathlib
import signal
import subprocess
import sys
import time


def processes(program):
    """Numbers of the processes that this one's tree runs of a program."""
    parents, own = {}, {os.getpid()}
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                status = (entry / "stat").read_text().rsplit(")", 1)[1].split()
                parents[int(entry.name)] = (int(status[1]), os.readlink(entry / "exe"))
            except OSError:
                pass
    grown = True
    while grown:
        more = {pid for pid, (parent, _) in parents.items() if parent in own} - own
        own |= more
        grown = bool(more)
    return [pid for pid in own if pid in parents and parents[pid][1] == program]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("config")
    parser.add_argument("folder")
    parser.add_argument("--workers", type=int, default=4)
    parser.add_argument("--kill-every", type=float, default=20.0)
    parser.add_argument("--lacuna", default="lacuna")
    arguments = parser.parse_args()
    folder = pathlib.Path(arguments.folder)
    lacuna = os.path.realpath(arguments.lacuna)
    study = [lacuna, "study", "--config", arguments.config]
    keys = subprocess.run(study + ["--cases"], check=True, capture_output=True, text=True).stdout.split()

    began = time.time()
    single = ["--threads", "1", "--quiet", "--out", str(folder / "plain")]
    for key in keys:
        subprocess.run(study + ["--case", key] + single, check=True, stdout=subprocess.DEVNULL)
    plain = time.time() - began
    subprocess.run([lacuna, "study", "merge", str(folder / "plain"), "--out", str(folder / "plain/whole"), "--quiet"],
                   check=True, stdout=subprocess.DEVNULL)

    here = pathlib.Path(__file__).parent
    began, killed = time.time(), 0
    engine = subprocess.Popen(
        [sys.executable, str(here / "hyperqueue_exam.py"), arguments.config, str(folder / "queue"),
         "--workers", str(arguments.workers), "--lacuna", lacuna],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    next_kill = began + arguments.kill_every
    while engine.poll() is None:
        time.sleep(0.05)
        if time.time() >= next_kill:
            found = processes(lacuna)
            if found:
                try:
                    os.kill(found[0], signal.SIGKILL)
                    killed += 1
                    next_kill += arguments.kill_every
                except ProcessLookupError:
                    pass
    queue = time.time() - began
    same = all((folder / "plain/whole" / name).read_bytes() == (folder / "queue/whole" / name).read_bytes()
               for name in ["study.json", "cases.csv", "report.html"])
    print(f"{len(keys)} cases: plain processes {plain:.1f} s, one at a time; HyperQueue with "
          f"{arguments.workers} workers {queue:.1f} s, {killed} killed; same bytes: {same}")
    sys.exit(0 if same and engine.returncode == 0 else 1)


if __name__ == "__main__":
    main()
