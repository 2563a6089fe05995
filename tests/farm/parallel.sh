#!/usr/bin/env bash
# The lines that `floe submit commands` writes, run by GNU parallel: of a run with a bad frame only that frame is repeated.
#
#   tests/farm/parallel.sh [--install] [--keep]
#
# --install gets Debian's package by apt (as root); without it nothing is tested. --keep leaves the temporary folder.
# FLOE is the program [target/release/floe].
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/farm/common.sh

for argument in "$@"; do
    case $argument in
        --install) apt-get install -y --no-install-recommends parallel ;;
        --keep) keep=yes ;;
        *) echo "unknown argument $argument; see the head of $0" >&2; exit 2 ;;
    esac
done
need parallel
export PARALLEL_HOME=$folder/parallel
mkdir "$PARALLEL_HOME" && touch "$PARALLEL_HOME/will-cite"

scene "$folder/it's a scene" 5 16
"$floe" render "$folder/it's a scene" --output "$folder/local/f_####.exr" --quiet > /dev/null
frames=$folder/it\'s\ a\ scene/frames
head -c 5000 sequences/iceberg/frames/frame_0002.ply > "$frames/frame_0002.ply"
"$floe" submit commands "$folder/it's a scene" --output "$folder/a \"run\"/f_####.exr" --cpus 1 --write "$folder/job" 2> /dev/null

step "five tasks, one of a frame that is cut short"
[ "$(wc -l < "$folder/job/commands.txt")" = 5 ]
if parallel --jobs 2 --joblog "$folder/tasks.log" < "$folder/job/commands.txt" > /dev/null 2>&1; then exit 1; fi
[ "$(awk 'NR > 1 { print $7 }' "$folder/tasks.log" | sort | tr '\n' ' ')" = "0 0 0 0 65 " ]

step "once it is mended, only that one is repeated"
cp sequences/iceberg/frames/frame_0002.ply "$frames/"
parallel --jobs 2 --joblog "$folder/tasks.log" --resume-failed < "$folder/job/commands.txt" > /dev/null 2>&1
[ "$(wc -l < "$folder/tasks.log")" = 7 ]
[ "$(tail -n 1 "$folder/tasks.log" | cut -f 1,7)" = $'3\t0' ]
same local 'a "run"'

step "a scheduler that counts tasks runs one line"
rm "$folder/a \"run\"/f_0004.exr"
sh "$folder/job/task.sh" 5 > /dev/null 2>&1
same local 'a "run"'

passed
