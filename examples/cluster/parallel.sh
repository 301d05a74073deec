#!/bin/sh
# Works an exam off with GNU parallel: on this machine, or on others with --sshlogin.
#
#   examples/cluster/parallel.sh CONFIG OUT [OPTIONS OF PARALLEL]
set -eu
config=$1 out=$2
shift 2
lacuna=${LACUNA:-lacuna}

mkdir -p "$out"
"$lacuna" study --config "$config" --cases >"$out/cases.txt"
parallel --retries 5 --will-cite "$@" -a "$out/cases.txt" \
    "$lacuna" study --config "$config" --out "$out" --threads 1 --quiet --case
"$lacuna" study merge "$out" --out "$out/whole"
