# Sourced by scripts/demo, scripts/test and .ci/run; not run by itself.
# lw_install_packages puts the Debian packages of packages.txt in place, lw_build configures and builds a preset.

lw_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Objects are shared between clones that lie side by side, and between presets of equal flags.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$(dirname "$lw_root")}
export CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR:-1}

lw_fail() {
    echo "latewarp: error: $*" >&2
    exit 1
}

lw_missing_packages() {
    local installed
    installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' $(cat "$lw_root/scripts/packages.txt") 2>/dev/null |
        sed -n 's/ installed$//p' || true) # fails when it knows none of a name
    comm -23 <(sort -u "$lw_root/scripts/packages.txt") <(sort -u <<<"$installed")
}

# Touches neither the network nor apt when everything is there.
lw_install_packages() {
    local name
    name=$(. /etc/os-release 2>/dev/null && echo "${ID:-unknown} ${VERSION_ID:-}")
    if [[ $name != "debian 12" ]]; then
        echo "latewarp: this is ${name% }; the set-up knows Debian 12. Install the counterparts of these packages:" >&2
        tr '\n' ' ' <"$lw_root/scripts/packages.txt" >&2
        echo >&2
        lw_fail "unknown distribution: ${name% }: then build with 'cmake --preset release && cmake --build --preset release'"
    fi
    local missing
    missing=$(lw_missing_packages | tr '\n' ' ')
    [[ -n ${missing// /} ]] || return 0
    local install="apt-get install -y --no-install-recommends ${missing% }"
    local as_root=()
    if [[ $(id -u) -ne 0 ]]; then
        as_root=(sudo)
        # Without a terminal sudo must not ask for a password.
        [[ -t 0 ]] || as_root=(sudo -n)
        if ! command -v sudo >/dev/null || { [[ ! -t 0 ]] && ! sudo -n true 2>/dev/null; }; then
            echo "Run this as root, then start again:" >&2
            echo "    apt-get update && $install" >&2
            lw_fail "packages are missing: ${missing% }: this user may not install them"
        fi
    fi
    echo "Installing: ${missing% }"
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive $install
}

# lw_configure PRESET [cmake arguments]: only when there is no build folder yet; ninja itself notices changed lists.
lw_configure() {
    local preset=$1
    shift
    local log="$lw_root/build/$preset/configure.log"
    [[ -f $lw_root/build/$preset/build.ninja ]] && return 0
    mkdir -p "$(dirname "$log")"
    echo "Configuring $preset"
    (cd "$lw_root" && cmake --preset "$preset" "$@" >"$log" 2>&1) || {
        cat "$log" >&2
        lw_fail "the build cannot be configured: build/$preset: see the messages above"
    }
}

# lw_build PRESET [targets]: everything when no target is named.
lw_build() {
    local preset=$1
    shift
    local targets=()
    [[ $# -eq 0 ]] || targets=(--target "$@")
    (cd "$lw_root" && cmake --build --preset "$preset" -j "$(nproc)" "${targets[@]}")
}
