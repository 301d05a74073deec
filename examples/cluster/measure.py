#!/usr/bin/env python3
"""Measures what HyperQueue costs, and that nothing is lost when processes die and a disk is full.

    examples/cluster/measure.py CONFIG FOLDER [--workers 4] [--kill-every 20] [--disk MB]

Works the exam of CONFIG off by plain processes, one a case, one after another; then by HyperQueue
while every so many seconds something is killed with signal 9: the process of a task and the engine with
all its workers by turns, the engine to be started again; compares the bytes. With --disk the
results lie on a file system of that size (a tmpfs, which takes root and is given back at the end), and once
it is full to the last byte for five seconds.
"""

import argparse
import os
import pathlib
import resource
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


class Disk:
    """A file system of a size that is full for a while, once."""

    def __init__(self, at, megabytes):
        at.mkdir(parents=True)
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={megabytes}m", "tmpfs", str(at)], check=True)
        self.at, self.ballast, self.until, self.done = at, at / "ballast", None, 0

    def turn(self, done, enough):
        """Fills it once enough is done, and makes room again five seconds later; counts what was done meanwhile."""
        if self.until is None:
            if done > enough:
                self.fill(done)
        elif self.ballast.exists() and time.time() > self.until:
            self.ballast.unlink()
            self.done += done

    def fill(self, done):
        """Writes until not one more byte fits."""
        self.until, self.done = time.time() + 5.0, -done
        with open(self.ballast, "wb", buffering=0) as file:
            for block in [1 << 20, 1 << 12, 1]:
                try:
                    while file.write(b"0" * block) == block:
                        pass
                except OSError:
                    pass

    def close(self):
        """Gives it back, with what lies on it."""
        subprocess.run(["umount", str(self.at)], check=True)


def spent():
    """CPU seconds of all processes that were started here and have ended: other programs do not count."""
    own = resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("config")
    parser.add_argument("folder")
    parser.add_argument("--workers", type=int, default=4)
    parser.add_argument("--kill-every", type=float, default=20.0)
    parser.add_argument("--disk", type=int, help="size in MB of the file system that is full once")
    parser.add_argument("--lacuna", default="lacuna")
    arguments = parser.parse_args()
    folder = pathlib.Path(arguments.folder)
    lacuna = os.path.realpath(arguments.lacuna)
    study = [lacuna, "study", "--config", arguments.config]
    keys = subprocess.run(study + ["--cases"], check=True, capture_output=True, text=True).stdout.split()

    began, before = time.time(), spent()
    single = ["--threads", "1", "--quiet", "--out", str(folder / "plain")]
    for key in keys:
        subprocess.run(study + ["--case", key] + single, check=True, stdout=subprocess.DEVNULL)
    plain, plain_cpu = time.time() - began, spent() - before
    subprocess.run([lacuna, "study", "merge", str(folder / "plain"), "--out", str(folder / "plain/whole"), "--quiet"],
                   check=True, stdout=subprocess.DEVNULL)

    here = pathlib.Path(__file__).parent
    out = folder / "queue"
    disk = Disk(out, arguments.disk) if arguments.disk else None
    before = spent()
    began, killed = time.time(), {"task": 0, "engine": 0}
    command = [sys.executable, str(here / "hyperqueue_exam.py"), arguments.config, str(out),
               "--workers", str(arguments.workers), "--lacuna", lacuna]

    def start():
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    engine = start()
    next_kill = began + arguments.kill_every
    while engine.poll() is None:
        time.sleep(0.05)
        if disk:
            disk.turn(len(list((out / "marks").glob("*.json"))), len(keys) // 3)
        if time.time() < next_kill:
            continue
        if killed["task"] > killed["engine"]:
            engine.kill()
            engine.wait()
            killed["engine"] += 1
            engine = start()
            next_kill += arguments.kill_every
        elif found := processes(lacuna):
            try:
                os.kill(found[0], signal.SIGKILL)
                killed["task"] += 1
                next_kill += arguments.kill_every
            except ProcessLookupError:
                pass
    queue, queue_cpu = time.time() - began, spent() - before
    same = all((folder / "plain/whole" / name).read_bytes() == (folder / "queue/whole" / name).read_bytes()
               for name in ["study.json", "cases.csv", "report.html"])
    full = f", disk full for 5 s, {disk.done} cases done in that time" if disk else ""
    if disk:
        disk.close()
    print(f"{len(keys)} cases: plain processes {plain:.1f} s ({plain_cpu:.1f} CPU s), one at a time; "
          f"HyperQueue with {arguments.workers} workers {queue:.1f} s ({queue_cpu:.1f} CPU s), "
          f"{killed['task']} tasks and {killed['engine']} engines killed{full}; same bytes: {same}")
    sys.exit(0 if same and engine.returncode == 0 else 1)


if __name__ == "__main__":
    main()
