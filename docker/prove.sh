#!/usr/bin/env bash
# Builds the image as the Dockerfile says, starts what it starts, as the user it names, asks it as its health check does and
# renders a sample through it. Needs buildah, no daemon and no container engine: docker/prove.sh [ROOT.tar]
# ROOT.tar stands for debian:12-slim where no registry can be reached, for example what debootstrap --variant=minbase makes.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

readonly image=afterglow-proof
readonly store=${PROOF_STORE:-build/proof}
readonly token=proof-$RANDOM$RANDOM$RANDOM
mkdir -p "$store"
export BUILDAH_ISOLATION=chroot STORAGE_DRIVER=${STORAGE_DRIVER:-vfs}

builder() { buildah --root "$(readlink -f "$store")/images" --runroot "$(readlink -f "$store")/run" "$@"; }
say() { printf '== %s\n' "$*"; }
# A value of the image's configuration, the words of a list from the given one on.
config() {
    builder inspect --type image $image | python3 -c '
import json, sys
value = json.load(sys.stdin)["Docker"]["config"]
for name in sys.argv[1].split("."): value = value[name]
print(value if isinstance(value, str) else " ".join(value[int(sys.argv[2]):]))' "$1" "${2:-0}"
}

if [[ -n ${1-} ]]; then
    say "debian:12-slim is $1"
    base=$(builder from scratch)
    builder add --quiet "$base" "$1" / >/dev/null
    builder commit --quiet --rm "$base" docker.io/library/debian:12-slim >/dev/null
fi

say "building"
builder build --format docker --layers --pull-never -f docker/Dockerfile -t $image .

say "user $(config User), entry point $(config Entrypoint), health check $(config Healthcheck.Test 1)"
container=$(builder from --pull-never $image)
clean_up() {
    # Asked to stop from inside: what runs there does not end with the builder.
    if [[ -n ${service-} ]]; then
        inside sh -c 'kill $(pidof afterglowd)' 2>/dev/null || true
        wait "$service" 2>/dev/null || true
    fi
    builder rm "$container" >/dev/null
}
trap clean_up EXIT
inside() { builder run "$container" -- "$@"; }
# The image is read: a token, a scene and what the test needs are put beside it.
secret=$(mktemp)
echo "proof admin $token" >"$secret"
builder copy --quiet --chmod 644 "$container" "$secret" /tokens >/dev/null
rm "$secret"
builder copy --quiet --chmod 644 "$container" tests/data/cornell-slide.glb /sample.glb >/dev/null

say "starting"
# shellcheck disable=SC2046
inside $(config Entrypoint) --token-file /tokens &
service=$!
# The health check's own words, until it holds.
for ((second = 0; second < 60; ++second)); do
    # shellcheck disable=SC2046
    inside $(config Healthcheck.Test 1) && break
    kill -0 "$service"
    sleep 1
done
((second < 60))

say "rendering"
inside sh -c 'test "$(id -u)" = 10001 && ! touch /usr/local/bin/mark 2>/dev/null && touch /data/mark'
inside env AFTERGLOW_TOKEN="$token" afterglow submit /sample.glb --frames 0-2 --size 160x120 --quality draft --out /tmp/frames
[[ $(inside sh -c 'ls /tmp/frames/frame_*.png | wc -l') -eq 3 ]]
say "proved: built, started without rights, healthy, three frames rendered"
