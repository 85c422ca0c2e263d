#!/bin/sh
# sh tests/report/run.sh FRAMESIM: makes a report and opens it in headless Chromium through its WebDriver, as a reader would:
# no error on the console, no request out, the table sorts by mouse and by keyboard, pictures are not empty, nothing is wider
# than the window at 1280 and at 400 pixels. Exit code 77: there is no Chromium here.
set -eu
framesim=$1
command -v chromedriver >/dev/null && command -v chromium >/dev/null && command -v curl >/dev/null || {
  echo "report: skipped, chromium, chromium-driver and curl are not all there"
  exit 77
}
folder=$(mktemp -d)
driver=
session=
# chromedriver's own port, on this machine's loopback address only.
port=$((20000 + $$ % 20000))
address=http://127.0.0.1:$port/session

finish() {
  [ -z "$session" ] || curl -s -X DELETE "$address/$session" >/dev/null 2>&1 || true
  [ -z "$driver" ] || kill "$driver" 2>/dev/null || true
  rm -rf "$folder"
}
trap finish EXIT
trap 'exit 1' INT TERM
fail() { echo "report: $*" >&2; exit 1; }

# post PATH JSON
post() { curl -s --max-time 60 -H 'Content-Type: application/json' -d "$2" "$address$1"; }

# ask SCRIPT: what it returns in the page, as JSON text.
ask() {
  post "/$session/execute/sync" "{\"script\": \"$1\", \"args\": []}" | sed -n 's/^{"value"://; s/}$//p'
}
# expect WANTED SCRIPT
expect() {
  found=$(ask "$2")
  [ "$found" = "$1" ] || fail "expected $1, found $found: $2"
}

"$framesim" compare --scenes street,graphicon-forest --frames 300 --policies full-detail,feedback,funkhouser,robin-hood --quiet \
  --report "$folder/report.html" -o "$folder/table.txt"
chromedriver --port=$port --log-level=OFF >"$folder/log" 2>&1 &
driver=$!
tries=0
until curl -s "http://127.0.0.1:$port/status" 2>/dev/null | grep -q '"ready":true'; do
  tries=$((tries + 1))
  [ "$tries" -lt 100 ] || fail "chromedriver does not answer"
  sleep 0.2
done
answer=$(post '' '{"capabilities": {"alwaysMatch": {"goog:loggingPrefs": {"browser": "ALL"}, "goog:chromeOptions":
  {"args": ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1280,900"]}}}}')
session=$(echo "$answer" | sed -n 's/.*"sessionId":"\([^"]*\)".*/\1/p')
[ -n "$session" ] || fail "no browser: $answer"

post "/$session/url" "{\"url\": \"file://$folder/report.html\"}" >/dev/null
expect '"framesim report"' "return document.title"
expect 8 "return document.querySelectorAll('#errors tbody tr').length"
expect 0 "return performance.getEntriesByType('resource').filter(e => !e.name.startsWith('data:')).length"

# The column AvgErr by mouse, down by keyboard: sorted as numbers.
values="[...document.querySelectorAll('#errors tbody tr')].map(r => Number(r.cells[at].textContent))"
at="const at = [...document.querySelectorAll('#errors th')].findIndex(h => h.textContent.startsWith('AvgErr'));"
rises="const v = $values; return v.every((x, i) => !i || v[i-1] <= x) && v[0] < v[v.length-1]"
falls="const v = $values; return v.every((x, i) => !i || v[i-1] >= x) && v[0] > v[v.length-1]"
expect false "$at $rises"
expect true "$at document.querySelectorAll('#errors th button')[at].click(); $rises"
ask "$at document.querySelectorAll('#errors th button')[at].focus()" >/dev/null
post "/$session/actions" '{"actions": [{"type": "key", "id": "k", "actions": [{"type": "keyDown", "value": "\uE007"},
  {"type": "keyUp", "value": "\uE007"}]}]}' >/dev/null
expect true "$at $falls"
expect '"descending"' "$at return document.querySelectorAll('#errors th')[at].getAttribute('aria-sort')"

# Every canvas has some of its pixels painted, and the diagram its points.
painted="c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some(v => v > 0)"
expect true "return [...document.querySelectorAll('#times canvas:first-of-type, #mix canvas:first-of-type, #map')].every(c => $painted)"
expect true "return document.querySelectorAll('#times canvas').length > 0 && document.querySelectorAll('#work circle').length === 4"

# A zoom shows fewer frames, and All frames brings them back; another frame from above is another picture.
expect true "const note = () => document.getElementById('times-note').textContent, before = note();
  document.querySelector('[data-zoom=in]').click(); const zoomed = note(); document.querySelector('[data-zoom=all]').click();
  return before !== zoomed && note() === before"
expect true "const map = document.getElementById('map'), slider = document.getElementById('view-frame'), before = map.toDataURL();
  slider.value = 20; slider.dispatchEvent(new Event('input')); return map.toDataURL() !== before"
# The other scene's curves, and a row of the table that is clicked.
expect true "const block = document.getElementById('block'), before = document.getElementById('run').innerHTML;
  document.querySelector('#errors tbody tr:not([aria-selected=true])').click(); block.selectedIndex = 1;
  block.dispatchEvent(new Event('change')); return before !== document.getElementById('run').innerHTML"

for width in 1280 400; do
  post "/$session/window/rect" "{\"width\": $width, \"height\": 900}" >/dev/null
  expect true "return document.documentElement.scrollWidth <= window.innerWidth"
done
for scheme in dark light; do
  post "/$session/goog/cdp/execute" "{\"cmd\": \"Emulation.setEmulatedMedia\", \"params\":
    {\"features\": [{\"name\": \"prefers-color-scheme\", \"value\": \"$scheme\"}]}}" >/dev/null
  # Text and background are far apart: the sum of their channels differs by more than half of what is possible.
  expect true "const s = getComputedStyle(document.body), sum = c => c.match(/[0-9]+/g).slice(0, 3).reduce((a, b) => a + +b, 0);
    return Math.abs(sum(s.color) - sum(s.backgroundColor)) > 383"
done

console=$(post "/$session/se/log" '{"type": "browser"}')
[ "$console" = '{"value":[]}' ] || fail "the console is not empty: $console"
echo "report: opens without a request or an error, sorts, zooms, is drawn and readable at 1280 and at 400 pixels"
