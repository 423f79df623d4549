# shellcheck shell=bash
# Bare roots of Debian, in which nothing is installed but what debootstrap puts into the smallest: to be sourced, not run.
# A script that uses them runs as root and calls leave_root at its end. It is then in the repository's own folder.

# shellcheck source=tools/steps.bash
source "$(dirname -- "${BASH_SOURCE[0]}")/../../tools/steps.bash"

# The archive that this machine's own packages come from; those of all of Debian's releases lie there beside each other.
debian_archive() {
    # shellcheck disable=SC2016
    apt-get --no-release-info indextargets --format '$(REPO_URI)|$(RELEASE)|$(COMPONENT)' 'Created-By: Packages' |
        sed -nE '/^cdrom:/d; /^(.+)\|(bookworm|trixie|stable|oldstable)\|main$/{s//\1/p;q}'
}

# debian_tree FOLDER SUITE: a smallest Debian in the folder, unless there is one.
debian_tree() {
    local archive
    if [[ -x $1/bin/sh ]]; then
        return
    fi
    needs "the package debootstrap" debootstrap
    archive=$(debian_archive)
    if [[ -z $archive ]]; then
        echo "$0: apt's sources name no archive of Debian (component main) to make a bare root from" >&2
        exit 2
    fi
    debootstrap --variant=minbase "$2" "$1" "$archive" >/dev/null
}

# bare_root FOLDER SUITE: such a tree that can be worked in, with processes, devices and the network.
bare_root() {
    debian_tree "$1" "$2"
    chmod 755 "$1" # else its users are shut out of it
    cp /etc/resolv.conf "$1/etc/resolv.conf"
    mountpoint --quiet "$1/proc" || mount -t proc proc "$1/proc"
    if ! mountpoint --quiet "$1/dev"; then
        mount --rbind /dev "$1/dev"
        mount --make-rslave "$1/dev" # what is unmounted there stays mounted here
    fi
}

# leave_root FOLDER: unmounts all of this machine that is mounted there; fails if something stays mounted.
leave_root() {
    local place
    for place in "$1/proc" "$1/dev"; do
        if mountpoint --quiet "$place"; then
            umount --recursive "$place" || return
        fi
    done
}

# remove_root FOLDER: leaves it and removes it.
remove_root() {
    leave_root "$1" && rm -rf --one-file-system "$1"
}

# inside_root FOLDER COMMAND...: runs the command there, with nothing of this machine's environment.
inside_root() {
    local root=$1
    shift
    chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"
}
