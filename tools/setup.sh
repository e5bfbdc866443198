# What ./run and ./test share; sourced by them.

say() { printf '\033[1m== %s\033[0m\n' "$*" >&2; }

need_rust() {
    if ! command -v cargo >/dev/null; then
        say "Rust is missing: install it from https://rustup.rs, then run this again"
        exit 1
    fi
}

# Installs those of the Debian packages that are missing: as root, else with sudo, else it prints
# the one line to run.
need_packages() {
    local missing=() package
    for package in "$@"; do
        if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" != installed ]; then
            missing+=("$package")
        fi
    done
    [ ${#missing[@]} -eq 0 ] && return
    say "installing ${missing[*]}"
    local as=()
    if [ "$(id -u)" != 0 ]; then
        if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
            as=(sudo)
        else
            say "run this once, then again: su -c 'apt-get update && apt-get install -y ${missing[*]}'"
            exit 1
        fi
    fi
    "${as[@]}" apt-get update -qq
    "${as[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq "${missing[@]}" >/dev/null
}
