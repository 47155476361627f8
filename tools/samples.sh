#!/usr/bin/env bash
# Makes data/ from Debian packages: a head CT (invesalius-examples), MR heads and label atlases (mricron-data), of which a
# PET scan is simulated, and CC0 environments (blender-data). Does nothing where the files are there; fails when a package cannot be had.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { printf 'samples: %s\n' "$*" >&2; }
root() { if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo "$@"; else return 1; fi; }
updated=

package() {  # package NAME FILE: makes sure that FILE of package NAME is on the machine
  [ -e "$2" ] && return 0
  local failed=data/.no-$1  # a package that cannot be had is asked for once a day
  [ -n "$(find "$failed" -mmin -1440 2>/dev/null)" ] && { say "package $1 cannot be had (remove $failed to try again)"; return 1; }
  command -v apt-get >/dev/null || { say "missing: $2, of Debian's package $1"; return 1; }
  say "installing $1"
  [ -n "$updated" ] || root apt-get update >/dev/null 2>&1 || true
  updated=yes
  DEBIAN_FRONTEND=noninteractive root apt-get install -y --no-install-recommends "$1" >/dev/null 2>&1 </dev/null || true
  [ -e "$2" ] || { touch "$failed"; say "package $1 cannot be had"; return 1; }
}

head_ct() {
  [ -f data/head-ct.nrrd ] && return 0
  local archive=/usr/share/doc/invesalius-examples/examples/Cranium.inv3 folder
  package invesalius-examples "$archive" || return 1
  say "data/head-ct.nrrd"
  folder=$(mktemp -d)
  tar -xzf "$archive" -C "$folder" --wildcards '*/matrix.dat' --strip-components=1
  [ "$(stat -c %s "$folder/matrix.dat")" = 14155776 ] || { say "$archive: matrix.dat is not 256x256x108 int16"; return 1; }
  # Index x grows to the patient's left, y to anterior, z to the head; the volume's centre is put at 0,0,0.
  {
    printf 'NRRD0004\ntype: int16\ndimension: 3\nspace: left-posterior-superior\nsizes: 256 256 108\n'
    printf 'space directions: (0.9570312,0,0) (0,-0.9570312,0) (0,0,1.5)\nkinds: domain domain domain\n'
    printf 'endian: little\nencoding: raw\nspace origin: (-122.021478,122.021478,-80.25)\nmodality:=CT\n\n'
    cat "$folder/matrix.dat"
  } > data/head-ct.nrrd.part
  mv data/head-ct.nrrd.part data/head-ct.nrrd
  rm -rf "$folder"
}

mri() {
  [ -f data/brodmann.nii.gz ] && return 0
  local from=/usr/share/mricron/templates
  package mricron-data $from/ch2.nii.gz || return 1
  say "data/mri-head.nii.gz and label atlases"
  cp -L $from/ch2.nii.gz data/mri-head.nii.gz
  cp -L $from/ch2bet.nii.gz data/mri-brain.nii.gz
  cp -L $from/aal.nii.gz $from/aal.nii.txt $from/aal.nii.lut $from/brodmann.nii.lut data/
  cp -L $from/brodmann.nii.gz data/brodmann.nii.gz.part && mv data/brodmann.nii.gz.part data/brodmann.nii.gz
}

pet() {  # a second modality of the MR brain, for want of a measured one
  [ -f data/simulated-pet.nrrd ] && return 0
  [ -f data/aal.nii.gz ] || return 1
  command -v python3 >/dev/null || { say "data/simulated-pet.nrrd needs python3"; return 0; }
  say "data/simulated-pet.nrrd"
  python3 tools/simulated_pet.py data/aal.nii.gz data/simulated-pet.nrrd.part
  mv data/simulated-pet.nrrd.part data/simulated-pet.nrrd
}

environments() {
  [ -f data/env/.complete ] && return 0
  local from=/usr/share/blender/datafiles/studiolights/world
  package blender-data "$from" || return 1
  say "data/env/"
  mkdir -p data/env
  cp -L $from/*.exr data/env/
  touch data/env/.complete
}

mkdir -p data
status=0
head_ct || status=1
mri || status=1
pet || status=1
environments || status=1
exit $status
