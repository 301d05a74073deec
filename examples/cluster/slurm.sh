#!/bin/sh
# Works an exam off as a Slurm array, a case a task; tasks of nodes that fail are started again.
#
#   examples/cluster/slurm.sh CONFIG OUT
#   lacuna study merge OUT --out OUT/whole        # when the array has ended; names what is missing
set -eu
config=$1 out=$2
lacuna=${LACUNA:-lacuna}
here=$(cd "$(dirname "$0")" && pwd)

mkdir -p "$out/errors"
"$lacuna" study --config "$config" --cases >"$out/cases.txt"
sbatch --requeue --array="1-$(wc -l <"$out/cases.txt")" --cpus-per-task=1 --time=01:00:00 \
    --output=/dev/null --error="$out/errors/%a" "$here/one.sh" "$lacuna" "$config" "$out"
