# What the scripts of this folder share: a temporary folder, waiting, and a small sequence.

floe=$(realpath "${FLOE:-target/release/floe}" 2>/dev/null || true)
folder=$(mktemp -d)
keep=
cleanups=()

on_exit() { cleanups+=("$1"); }
leave() {
    local cleanup
    for cleanup in "${cleanups[@]}"; do "$cleanup"; done
    if [ -n "$keep" ]; then echo "everything is in $folder"; else rm -rf "$folder"; fi
}
trap leave EXIT
trap 'echo "FAILED: line $LINENO: $BASH_COMMAND" >&2' ERR
set -o errtrace

# Without the program or a scheduler there is nothing to test.
need() {
    local program
    if [ ! -x "$floe" ]; then echo "there is no floe: cargo build --release, or set FLOE" >&2; exit 2; fi
    for program in "$@"; do
        if ! command -v "$program" > /dev/null; then echo "skipped: there is no $program (--install, or see the head of $0)"; exit 0; fi
    done
}

step() { printf '%3d s  %s\n' "$SECONDS" "$1"; }
passed() { step "all passed"; }

# Waits until a command succeeds.
await() {
    local what=$1 end=$((SECONDS + 120))
    shift
    until "$@" > /dev/null 2>&1; do
        if [ "$SECONDS" -ge "$end" ]; then echo "FAILED: waited two minutes for $what" >&2; return 1; fi
        sleep 0.1
    done
}

# The first frames of the iceberg in a small picture, with so many samples.
scene() {
    local frame
    mkdir -p "$1/frames"
    for ((frame = 0; frame < $2; frame++)); do cp "sequences/iceberg/frames/frame_000$frame.ply" "$1/frames/"; done
    cp sequences/iceberg/sky.exr "$1/"
    sed -e 's/^resolution = .*/resolution = [64, 36]/' -e "s/^samples = .*/samples = $3/" sequences/iceberg/scene.toml > "$1/scene.toml"
}

# Both folders have the same pictures, byte for byte.
same() {
    local picture
    for picture in "$folder/$1"/*.exr "$folder/$1"/*.png; do cmp "$picture" "$folder/$2/$(basename "$picture")"; done
}
