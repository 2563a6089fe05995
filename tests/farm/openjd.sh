#!/usr/bin/env bash
# The templates that `floe submit openjd` writes, run by the command line of Open Job Description.
#
#   tests/farm/openjd.sh [--install] [--keep]
#
# OPENJD is the program [openjd]; --install puts it (`openjd-cli` of PyPI) into the temporary folder.
# Without either nothing is tested. --keep leaves that folder. FLOE is the program [target/release/floe].
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/farm/common.sh

openjd=${OPENJD:-openjd}
for argument in "$@"; do
    case $argument in
        --install) python3 -m venv "$folder/venv"; "$folder/venv/bin/pip" install --quiet openjd-cli; openjd=$folder/venv/bin/openjd ;;
        --keep) keep=yes ;;
        *) echo "unknown argument $argument; see the head of $0" >&2; exit 2 ;;
    esac
done
need "$openjd"

scene "$folder/a scene" 7 256
"$floe" render "$folder/a scene" --output "$folder/local/f_####.exr" --quiet > /dev/null

step "both templates are right"
written() { "$floe" submit openjd "$folder/a scene" --output "$folder/$1/f_####.exr" --chunk 3 --cpus 1 --memory 100M --time 10m --write "$folder/$1 job" 2> /dev/null; }
written chunked
"$openjd" check "$folder/chunked job/template.yaml"
"$openjd" check "$folder/chunked job/plain.yaml" --extensions ""

step "three chunks, then the check"
"$openjd" run "$folder/chunked job/template.yaml" --step Check --run-dependencies > "$folder/chunked.log"
[ "$(grep -c 'Frame(CHUNK\[INT\]) =' "$folder/chunked.log")" = 3 ]
[ "$(grep -c 'openjd_progress: 100' "$folder/chunked.log")" = 3 ]
same local chunked

step "without the extension"
written plain
"$openjd" run "$folder/plain job/plain.yaml" --step Check --run-dependencies --extensions "" > "$folder/plain.log"
same local plain

step "cancelled: the frame is saved, and another run goes on with it"
written cancelled
"$openjd" run "$folder/cancelled job/template.yaml" --step Render > "$folder/cancelled.log" 2>&1 &
run=$!
await "the first picture" test -f "$folder/cancelled/f_0000.exr"
sleep 0.5
kill -TERM "$run"
if wait "$run"; then echo "FAILED: what was cancelled ended with 0" >&2; exit 1; fi
find "$folder/cancelled" -name '.f_*.checkpoint' | grep -q .
"$openjd" run "$folder/cancelled job/template.yaml" --step Check --run-dependencies > "$folder/again.log"
same local cancelled

step "a frame in a chunk that is not there is missed by the check, and by nothing else"
scene "$folder/gap" 5 4
rm "$folder/gap/frames/frame_0002.ply"
"$floe" submit openjd "$folder/gap" --frames 0-4 --chunk 5 --output "$folder/gaps/f_####.exr" --write "$folder/gap job" 2> /dev/null
"$openjd" run "$folder/gap job/template.yaml" --step Render > "$folder/gap.log"
if "$openjd" run "$folder/gap job/template.yaml" --step Check --run-dependencies > "$folder/gap.log" 2>&1; then
    echo "FAILED: the check takes four frames for five" >&2; exit 1
fi
grep -q '4 of 5 frames are there' "$folder/gap.log"

passed
