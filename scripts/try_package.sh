#!/bin/bash
# Makes the Debian package of build/, installs it in a bare Debian 12, and runs there every command of
# docs/tutorial.md, the Python module and a study; before that a scene with nothing but what the package
# depends on. As root; takes minutes; exit codes as of bare_debian.sh.
#   scripts/try_package.sh
set -u -o pipefail
root=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
source "$root/scripts/prepare.sh"
build
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
say "The package"
(cd "$root/build" && cpack -G DEB -B "$folder/made") || die "cpack failed"
mv "$folder"/made/*.deb "$folder/mortier.deb" && rm -rf "$folder/made"
"$root/tests/compare/tutorial.py" "$folder" || die "the tutorial cannot be read"
cat >"$folder/more.sh" <<'END'
set -ex
python3 -c '
import mortier
run = mortier.load("press.toml").run()
print(mortier.__file__, run.summary["status"])
assert run.summary["status"] == "converged"'
cp -r /usr/share/doc/mortier/examples examples
mortier check examples/scenes/compression.toml
mortier freefem examples/scenes/compression.toml compression.edp
grep /usr/share/mortier/freefem compression.edp
sed -i 's/^level = .*/level = [0, 1]/' examples/scenes/studies/note-space.toml
mortier study examples/scenes/studies/note-space.toml --out study
test -s study/report.html
man_page=$(zcat /usr/share/man/man1/mortier.1.gz | wc -l)
test "$man_page" -gt 100
END
# Without what the package recommends: runs, and a plot that says what it needs.
cat >"$folder/alone.sh" <<'END'
set -ex
mortier run /usr/share/doc/mortier/examples/scenes/compression.toml --quiet --out alone
test -s alone/summary.json
if mortier plot alone 2>plot.txt; then exit 1; fi
cat plot.txt
grep python3 plot.txt
END
"$root/scripts/bare_debian.sh" --of "$folder" \
  "apt-get update -q" \
  "DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends ./mortier.deb" \
  "sh alone.sh" "apt-get remove -y -q mortier" \
  "DEBIAN_FRONTEND=noninteractive apt-get install -y -q ./mortier.deb" \
  "sh tutorial.sh" "sh more.sh" "apt-get remove -y -q mortier" "! test -e /usr/share/mortier"
