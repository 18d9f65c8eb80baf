#!/bin/bash
# Prints the path of a Vulkan ICD file for a software driver with ray tracing; fetches that driver where it is missing.
#
# Debian 12's own lavapipe (Mesa 22.3) cannot trace rays; bookworm-backports has one that can. Installing it system-wide
# would disturb the machine's graphics stack, so one file of that package is unpacked into the user's cache, by a
# private apt configuration (own source list, lists, archives; apt still checks the signature). No root is needed.
# Debian 13's own driver is good: its ICD file is printed as it is.
set -euo pipefail

readonly kSystemIcd=/usr/share/vulkan/icd.d/lvp_icd.x86_64.json
readonly kSystemIcdNewer=/usr/share/vulkan/icd.d/lvp_icd.json
readonly kKeyring=/usr/share/keyrings/debian-archive-keyring.gpg
readonly kMirror="${Q3RT_DEBIAN_MIRROR:-http://deb.debian.org/debian}"

fail() { echo "q3rt set-up: $*" >&2; exit 1; }

codename="$(. /etc/os-release && echo "${VERSION_CODENAME:-unknown}")"
if [ "$codename" != bookworm ]; then
  for icd in "$kSystemIcd" "$kSystemIcdNewer"; do
    if [ -e "$icd" ]; then echo "$icd"; exit 0; fi
  done
  fail "no software Vulkan driver in /usr/share/vulkan/icd.d: install the package mesa-vulkan-drivers"
fi

target="${1:-${XDG_CACHE_HOME:-$HOME/.cache}/q3rt/lavapipe}"
icd="$target/lvp_icd.json"
# The folder is renamed into place as a whole, so a folder that exists is complete; the checksum catches damage since.
if [ -e "$icd" ] && (cd "$target" && sha256sum --quiet --check SHA256SUMS) >/dev/null 2>&1; then
  echo "$icd"
  exit 0
fi

mkdir -p "$(dirname "$target")" 2>/dev/null ||
  fail "cannot create $(dirname "$target"): set XDG_CACHE_HOME to a writable folder"
[ -e "$kKeyring" ] || fail "$kKeyring is missing: install the package debian-archive-keyring"
work="$(mktemp -d "$(dirname "$target")/lavapipe.XXXXXX")"
trap 'rm -rf "$work"' EXIT
# apt drops to the user _apt for downloads when root runs it: that user has to reach the folder.
chmod 755 "$work"
mkdir -p "$work"/apt/{lists/partial,archives/partial,conf.d,preferences.d,state} "$work/driver"
echo "deb [signed-by=$kKeyring] $kMirror bookworm-backports main" > "$work/apt/sources.list"
cat > "$work/apt/apt.conf" <<CONF
Dir::Etc::SourceList "$work/apt/sources.list";
Dir::Etc::SourceParts "-";
Dir::Etc::Preferences "-";
Dir::Etc::PreferencesParts "$work/apt/preferences.d";
Dir::State "$work/apt/state";
Dir::State::Lists "$work/apt/lists";
Dir::State::Status "/var/lib/dpkg/status";
Dir::Cache "$work/apt";
Dir::Cache::Archives "$work/apt/archives";
Acquire::Languages "none";
Acquire::Retries "2";
APT::Update::Post-Invoke "";
APT::Update::Post-Invoke-Success "";
Debug::NoLocking "true";
CONF
export APT_CONFIG="$work/apt/apt.conf"
# A fetch that failed is only a warning to apt: the index file is what tells.
apt-get -qq update >"$work/log" 2>&1 || true
compgen -G "$work/apt/lists/*bookworm-backports_main_binary*Packages*" >/dev/null || {
  grep -m1 '^[EW]:' "$work/log" >&2 || true
  fail "cannot reach $kMirror (bookworm-backports) for the ray-tracing software driver: check the network and run again"
}
(cd "$work/apt/archives" && apt-get -qq download mesa-vulkan-drivers >"$work/log" 2>&1) || {
  grep -m1 '^[EW]:' "$work/log" >&2 || true
  fail "cannot download mesa-vulkan-drivers from bookworm-backports: check the network and run again"
}
package="$(ls "$work"/apt/archives/mesa-vulkan-drivers_*.deb)"
dpkg-deb --fsys-tarfile "$package" | tar -x -C "$work/driver" --wildcards --transform='s,.*/,,' '*/libvulkan_lvp.so' ||
  fail "$(basename "$package") has no libvulkan_lvp.so: report this with the output of apt-cache policy"
absent="$(ldd "$work/driver/libvulkan_lvp.so" | awk '/not found/ { printf "%s ", $1 }')"
[ -z "$absent" ] || fail "the driver needs libraries that are not installed: $absent"
# A relative path with a slash is looked up beside this file; a bare name would load the system's old driver.
cat > "$work/driver/lvp_icd.json" <<'JSON'
{
    "file_format_version": "1.0.0",
    "ICD": { "library_path": "./libvulkan_lvp.so", "api_version": "1.4.305" }
}
JSON
basename "$package" > "$work/driver/PACKAGE"
(cd "$work/driver" && sha256sum libvulkan_lvp.so lvp_icd.json > SHA256SUMS)
rm -rf "$target"
mv "$work/driver" "$target"
echo "$icd"
