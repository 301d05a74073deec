#!/bin/sh
# One case of an exam, by its number in the list of keys: a task of a Slurm array.
set -eu
lacuna=$1 config=$2 out=$3
key=$(sed -n "${SLURM_ARRAY_TASK_ID}p" "$out/cases.txt")
exec "$lacuna" study --config "$config" --case "$key" --out "$out" --threads 1 --quiet
