# shellcheck shell=bash
# System packages: installs those that dpkg does not have, by default of packages-debian.txt. Sourced by tools/merlin.

package_list=$tools/setup/packages-debian.txt

wanted_packages() { sed 's/#.*//; s/[[:space:]]//g; /^$/d' "$package_list"; }

# Installed, or held at the installed version: the second letter of dpkg's status is i.
missing_packages() { # names...
  local installed
  installed=$(dpkg-query -W -f '${db:Status-Abbrev}${Package}\n' "$@" 2>/dev/null | sed -n 's/^.i. *//p') || true
  printf '%s\n' "$@" | grep -vxF -- "$installed" || true
}

# On Debian and its derivatives packages are installed; others are shown the list. MERLIN_OS_RELEASE is for the tests.
require_debian() {
  local os
  # shellcheck source=/dev/null
  os=$(. "${MERLIN_OS_RELEASE:-/etc/os-release}" 2>/dev/null && echo "${ID-} ${ID_LIKE-}") || os=unknown
  case " $os " in *" debian "*) return ;; esac
  say "set-up installs packages on Debian only; here (${os% }), install what corresponds to these Debian 12 packages:"
  wanted_packages >&2
  stop 3 "then fetch MuJoCo 4.0.0, set MUJOCO_ROOT to it, and build with: cmake --preset release && cmake --build --preset release"
}

install_packages() { # names...
  local missing log=$deps/apt-get.log as_root=() how="as root"
  missing=$(missing_packages "$@" | tr '\n' ' ')
  [ -n "$missing" ] || return 0
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
      stop 3 "needs root or sudo for the missing system packages; as root: apt-get install --no-install-recommends $missing"
    as_root=(sudo)
    how="through sudo"
  fi
  say "installing system packages that the build or the program needs, with apt-get $how (log: $log): $missing"
  # A package index that cannot be updated (a dead mirror, for example) is no reason to stop; a package that cannot be
  # installed is.
  # shellcheck disable=SC2086
  {
    "${as_root[@]}" apt-get -qq -o DPkg::Lock::Timeout=300 update || true
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 \
      apt-get -qq -y -o DPkg::Lock::Timeout=300 --no-install-recommends install $missing
  } >"$log" 2>&1 </dev/null || stop 3 "set-up stopped at the system packages: apt-get could not install them ($(apt_reason "$log")); no network?"
}

apt_reason() { grep -m 1 '^E: ' "$1" || echo "see $1"; }
