# Sourced by scripts that try frond in a Debian with nothing in it. Needs root, for chroot. DEBIAN_MIRROR is where packages come
# from; http://deb.debian.org/debian by default.

# bare SUITE FOLDER: a Debian with nothing in it but what apt needs.
bare() {
  as_root rm -rf "$2"
  quietly as_root debootstrap --variant=minbase "$1" "$2" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
  as_root cp /etc/resolv.conf "$2/etc/resolv.conf"
}

# inside FOLDER COMMAND...: with /proc, from which the dynamic linker knows where a program is.
inside() {
  local folder=$1
  shift
  as_root env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    CMAKE_BUILD_PARALLEL_LEVEL="${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" CCACHE_SLOPPINESS="$CCACHE_SLOPPINESS" \
    unshare --mount sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$folder" "$@"
}

# apt_inside FOLDER PACKAGE...
apt_inside() {
  local folder=$1
  shift
  quietly inside "$folder" apt-get install -y -qq --no-install-recommends "$@"
}
