#!/usr/bin/env python3
"""Works an exam off with HyperQueue (`pip install hyperqueue`): a case a task, no engine inside lacuna.

    examples/cluster/hyperqueue_exam.py CONFIG OUT [--workers 4] [--server DIR]

Without --server, a server and workers are started on this machine; with it, tasks go to the server
whose access file lies in that folder, wherever its workers are (Slurm and PBS among them). A task
whose worker or process dies is given again, until every case has its file; a case that is done
twice writes the same bytes. Then the results are merged into OUT/whole, which refuses gaps.
"""

import argparse
import pathlib
import subprocess
import sys
import time

from hyperqueue import Client, Job, LocalCluster
from hyperqueue.cluster import WorkerConfig

ROUNDS = 20


def missing(lacuna, config, out):
    listed = subprocess.run(
        [lacuna, "study", "--config", config, "--cases"], check=True, capture_output=True, text=True
    )
    return [key for key in listed.stdout.split() if not (out / "marks" / f"{key}.json").exists()]


def work(client, arguments, out):
    for turn in range(ROUNDS):
        # what is in the way, such as a full disk, may take a while to be mended
        time.sleep(turn)
        keys = missing(arguments.lacuna, arguments.config, out)
        if not keys:
            return
        job = Job(max_fails=None, default_workdir=pathlib.Path.cwd())
        for key in keys:
            job.program(
                [arguments.lacuna, "study", "--config", arguments.config, "--case", key]
                + ["--out", str(out), "--threads", "1", "--quiet", "--seed", str(arguments.seed)],
                stdout=None,
                stderr=str(out / "errors" / key),
            )
        client.wait_for_jobs([client.submit(job)], raise_on_error=False)
    sys.exit(f"still missing after {ROUNDS} rounds; see {out}/errors")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("config")
    parser.add_argument("out")
    parser.add_argument("--workers", type=int, default=4)
    parser.add_argument("--server")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--lacuna", default="lacuna")
    arguments = parser.parse_args()
    out = pathlib.Path(arguments.out).resolve()
    (out / "errors").mkdir(parents=True, exist_ok=True)
    if arguments.server:
        work(Client(arguments.server), arguments, out)
    else:
        with LocalCluster() as cluster:
            for _ in range(arguments.workers):
                cluster.start_worker(WorkerConfig(cores=1))
            work(cluster.client(), arguments, out)
    merge = [arguments.lacuna, "study", "merge", str(out), "--out", str(out / "whole")]
    sys.exit(subprocess.run(merge).returncode)


if __name__ == "__main__":
    main()
