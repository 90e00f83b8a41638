#!/usr/bin/env bash
# Build what a release uploads, check it, and use it as someone who cannot write to where it is installed (`make package`).
set -euo pipefail
python=$1
place=$(mktemp -d)
trap 'chmod -R u+w "$place"; rm -rf "$place"' EXIT
chmod 755 "$place"

rm -rf dist
"$python" -m venv "$place/tools"
"$place/tools/bin/pip" install --quiet --disable-pip-version-check build twine
"$place/tools/bin/python" -m build --outdir dist .
"$place/tools/bin/twine" check --strict dist/*

"$python" -m venv "$place/empty"
"$place/empty/bin/pip" install --quiet --no-compile --disable-pip-version-check dist/*.whl
chmod -R a-w "$place/empty"
mkdir -m 777 "$place/user"

# Root may write everywhere: another user it is, if this Python can be another's.
user=()
nobody=(setpriv --reuid=65534 --regid=65534 --clear-groups)
if [ "$(id -u)" = 0 ] && "${nobody[@]}" "$place/empty/bin/python" -c "" 2> /dev/null; then user=("${nobody[@]}"); fi
cd "$place/user"
"${user[@]}" env -i HOME=/nonexistent PATH="$place/empty/bin:/usr/bin:/bin" bash -euc '
  rockbatch --version
  rockbatch examples > /dev/null
  rockbatch init mine > /dev/null
  cd mine
  rockbatch run pier.toml || [ $? = 1 ]    # none of its foundations passes
  rockbatch report reports/pier
  test -s reports/pier/peaks.csv'
echo "used as user $("${user[@]}" id -u); ready to upload: $(cd "$OLDPWD" && echo dist/*)"
