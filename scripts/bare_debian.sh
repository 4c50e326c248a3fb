#!/bin/bash
# Runs commands in a bare Debian 12, on a copy of the last commit, as a new user would: a package that they
# forget to install is missing there, whatever this machine has.
#   scripts/bare_debian.sh COMMAND...     e.g. scripts/bare_debian.sh ./demo ./check
#   scripts/bare_debian.sh --of FOLDER COMMAND...     on a copy of a folder instead
# As root; installs debootstrap where it is missing. Exit code 125 where there can be no bare Debian here,
# with the reason; otherwise that of the first command that fails.
set -u -o pipefail
repository=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
impossible() { echo "no bare Debian: $*" >&2; exit 125; }

if [ "${1:-}" != --inside ]; then
  folder=
  [ "${1:-}" != --of ] || { folder=${2:-}; shift $(($# > 1 ? 2 : 1)); }
  [ $# -gt 0 ] || { echo "usage: scripts/bare_debian.sh [--of FOLDER] COMMAND..." >&2; exit 2; }
  [ "$(id -u)" -eq 0 ] || impossible "only root can make one"
  if ! command -v debootstrap >/dev/null; then
    { apt-get update -q &&
      DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends debootstrap; } \
      >/dev/null 2>&1 || impossible "debootstrap is missing and cannot be installed"
  fi
  root=$(mktemp -d)
  chmod 755 "$root"  # it becomes /, which every user of the bare Debian passes through
  trap 'rm -rf --one-file-system "$root"' EXIT
  mirror=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources} 2>/dev/null |
    grep -oEm1 'https?://[^ ]*/debian/?( |$)')
  mirror=${mirror:-http://deb.debian.org/debian}
  echo "== A bare Debian 12 from $mirror"
  timeout 900 debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 ||
    { tail -n 3 "$root.log" >&2; rm -f "$root.log"; impossible "debootstrap failed"; }
  rm -f "$root.log"
  mkdir -p "$root/opt/mortier"
  if [ -n "$folder" ]; then
    cp -r "$folder/." "$root/opt/mortier" || impossible "$folder cannot be copied"
  else
    git -c safe.directory='*' -C "$repository" archive HEAD | tar -x -C "$root/opt/mortier" ||
      impossible "the last commit cannot be copied"
  fi
  # In a mount namespace of its own: what is mounted goes with it, however this ends.
  unshare --mount --propagation private true 2>/dev/null || impossible "no mount namespace"
  unshare --mount --propagation private "$0" --inside "$root" "$@"
  exit
fi

root=$2
shift 2
mkdir -p "$root/dev/pts"
echo "127.0.0.1 localhost $(hostname)" >"$root/etc/hosts"  # otherwise MPI waits for a name server
{ mount -t proc proc "$root/proc" && mount -t devpts -o newinstance,ptmxmode=0666 devpts "$root/dev/pts"; } ||
  impossible "proc and devpts cannot be mounted"
ln -sfn /proc/self/fd "$root/dev/fd"
ln -sfn pts/ptmx "$root/dev/ptmx"
for command in "$@"; do
  echo "== $command in a bare Debian 12"
  chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root TERM="${TERM:-dumb}" \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
    sh -c "cd /opt/mortier && $command"
  status=$?
  [ $status -eq 0 ] || exit $((status == 125 ? 1 : status))
done
