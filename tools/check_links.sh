#!/usr/bin/env bash
# Fails when a Markdown file links to a file of the repository that is not there.
set -euo pipefail
cd "$(dirname "$0")/.."

bad=0
while IFS= read -r file; do
  while IFS= read -r target; do
    case $target in http*|'#'*|'') continue ;; esac
    [ -e "$(dirname "$file")/${target%%#*}" ] || { echo "$file: links to $target, which is not there" >&2; bad=1; }
  done < <(grep -o ']([^)]*)' "$file" | sed 's/^](//; s/)$//')
done < <(git ls-files '*.md')
[ $bad = 0 ] && echo "links: all there"
exit $bad
