# Shared by the scripts of this folder; source it from the repository's root. No script reads standard input.
export DEBIAN_FRONTEND=noninteractive
export CARGO_TERM_COLOR=never
# Debian's VTK and CGAL bindings belong to Debian's Python; another one on the PATH does not see them.
python=/usr/bin/python3

say() { printf '\n== %s\n' "$*"; }
die() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

# need PACKAGE...: installs what is missing of Debian's packages; asks the network only if something is.
need() {
  local package missing=()
  for package in "$@"; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  command -v apt-get >/dev/null || die "these packages are missing, and there is no apt-get to install them: ${missing[*]}"
  [ "$(id -u)" -eq 0 ] || die "these packages are missing, and installing them takes root: ${missing[*]}"
  say "installing ${missing[*]}"
  apt-get update -qq </dev/null
  apt-get install -y -qq --no-install-recommends "${missing[@]}" </dev/null >/dev/null
}

# need_rust: cargo of at least the version that Cargo.toml asks for.
need_rust() {
  [ -d "$HOME/.cargo/bin" ] && PATH="$PATH:$HOME/.cargo/bin"
  command -v cargo >/dev/null || die "cargo is missing; Debian 12's own is too old: install Rust from https://rustup.rs"
  local have want
  have=$(rustc --version | cut -d ' ' -f 2)
  want=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
  [ "$(printf '%s\n%s\n' "$want" "$have" | sort -V | head -n 1)" = "$want" ] || die "rustc $have is older than $want"
}

# cgal_meshes DIRECTORY: unpacks the meshes of CGAL's data set into DIRECTORY/data/meshes. They are documentation of the
# package libcgal-demo, and slim images leave documentation out when they install a package; then they are taken from the
# package file itself.
cgal_meshes() {
  local into=$1 archive=/usr/share/doc/libcgal-dev/data.tar.gz
  [ -e "$into/data/meshes/elephant.off" ] && return
  mkdir -p "$into"
  if [ ! -e "$archive" ]; then
    say "libcgal-demo's documentation is not on this machine; taking CGAL's data from the package"
    # Where apt's own user may write: it warns if it has to download as root.
    local scratch
    scratch=$(mktemp -d)
    chmod 755 "$scratch"
    chown _apt "$scratch" 2>/dev/null || true
    apt-get update -qq </dev/null
    (cd "$scratch" && apt-get download -qq libcgal-demo </dev/null && dpkg-deb -x libcgal-demo_*.deb "$OLDPWD/$into/package")
    rm -rf "$scratch"
    archive=$into/package/usr/share/doc/libcgal-dev/data.tar.gz
  fi
  tar -xzf "$archive" -C "$into" --wildcards 'data/meshes/*'
}
