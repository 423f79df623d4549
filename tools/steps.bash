# shellcheck shell=bash
# Functions that tools/demo and tools/test share: to be sourced, not run.

cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." || exit

jobs=$(nproc)
export jobs

# step TITLE COMMAND...: says what runs and how long it took
step() {
    local title=$1 began=$SECONDS
    shift
    printf '==> %s\n' "$title"
    "$@"
    printf '==> %s: %d s\n' "$title" "$((SECONDS - began))"
}

# needs PACKAGES PROGRAM...: ends if a program is missing that tools/setup does not install, since few need it
needs() {
    local packages=$1 program
    shift
    for program in "$@"; do
        if ! command -v "$program" >/dev/null; then
            echo "$0: $program is missing. Install $packages." >&2
            exit 2
        fi
    done
}

# Mesa's lavapipe becomes the only Vulkan driver, unless the caller has chosen one by the loader's own variables.
use_software_vulkan() {
    if [[ -n ${VK_DRIVER_FILES-}${VK_ICD_FILENAMES-}${VK_LOADER_DRIVERS_SELECT-} ]]; then
        return
    fi
    local file
    for file in /usr/share/vulkan/icd.d/lvp_icd{".$(uname -m)",}.json; do
        if [[ -r $file ]]; then
            export VK_DRIVER_FILES=$file
            return
        fi
    done
    echo "Mesa's lavapipe is not installed: no lvp_icd.json in /usr/share/vulkan/icd.d" >&2
    exit 3
}
