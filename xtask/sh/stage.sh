#!/bin/sh
# Runs one stage and says how long it took: stage.sh NAME COMMAND...
set -u
name=$1
shift
started=$(date +%s)
"$@"
status=$?
verdict=ok
[ "$status" -eq 0 ] || verdict="FAILED ($status)"
printf '== %s: %s, %d s\n' "$name" "$verdict" "$(($(date +%s) - started))"
exit "$status"
