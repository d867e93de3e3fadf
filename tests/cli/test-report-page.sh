#!/bin/sh
# Pages of real runs: well-formed, nothing in them leads to the network, and a real browser shows them in light, in dark
# and at the width of a phone (browser.py). A page with every fault that the browser looks for must not pass.
# usage: test-report-page.sh BUILD_FOLDER SOURCE_FOLDER
set -eu
cdem=$1/cdem source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export OMP_WAIT_POLICY=passive OPENBLAS_NUM_THREADS=1

"$cdem" run -q "$source/data/cases/brazilian-disc.yaml" --set mesh.parameters.h=0.012 --set end='0.4 ms' --set results.peak.tolerance=9 -o disc
"$cdem" run -q "$source/data/cases/hopper.yaml" --set grains.packing.count=80 --set end='0.1 s' --set walls.gate.stop='50 ms' \
  --set results.flow.from='60 ms' --set results.packed.from='60 ms' --set results.flow.tolerance=9 -o grains
for run in disc grains; do
  "$cdem" report -q $run
  python3 - $run <<'PAGE'
import os, re, sys, urllib.parse, xml.etree.ElementTree as tree
run = sys.argv[1]
page = open(run + "/report.html", encoding="utf-8").read()
root = tree.fromstring(page)  # strict: every element closed, every name known
wrong = []
for element in root.iter():
    if element.tag in ("script", "iframe", "object", "embed", "base", "form", "audio", "video"):
        wrong.append("element " + element.tag)
    for name, value in element.attrib.items():
        if name.startswith("on") or name in ("srcset", "action", "style"):
            wrong.append(f"attribute {name}")
        if name in ("src", "href"):
            place = value.split(":")[0]
            inside = value.startswith("#") or value.startswith("data:")
            if not inside and (":" in value or value.startswith("/") or not os.path.exists(os.path.join(run, urllib.parse.unquote(value)))):
                wrong.append(f"{name}={value[:60]}")
style = "".join(e.text or "" for e in root.iter("style"))
wrong += [w for w in ("@import", "url(", "http") if w in style]
text = re.sub(r"data:[^\"]*", "", page)
wrong += [f"{w} in the page" for w in ("http:", "https:", "//cdn") if w in text]
ids = [e.get("id") for e in root.iter() if e.get("id")]
if len(ids) != len(set(ids)):
    wrong.append("an id twice")
heads = [e.tag for e in root.iter() if re.fullmatch("h[1-6]", e.tag)]
if heads.count("h1") != 1 or any(int(b[1]) > int(a[1]) + 1 for a, b in zip(heads, heads[1:])):
    wrong.append(f"headings {heads}")
for table in root.iter("table"):
    if table.find("caption") is None:
        wrong.append("a table without a caption")
charts = [e for e in root.iter("figure") if e.get("class") == "chart"]
if len(charts) < 4 or sum(1 for _ in root.iter("img")) < 1:
    wrong.append(f"{len(charts)} charts")
for w in wrong:
    print(f"{run}: {w}")
print(f"{run}: {len(page)} characters, {len(charts)} charts")
sys.exit(bool(wrong))
PAGE
done

command -v chromium >/dev/null || { echo "chromium is not installed (Debian package chromium); the browser's part is skipped" >&2; exit 77; }
for run in disc grains; do
  python3 "$source/tests/cli/browser.py" $run/report.html shots-$run
  for shot in light dark phone phone-dark; do
    [ -s shots-$run/$shot.png ] || { echo "there is no screenshot $shot of $run"; exit 1; }
  done
  cmp -s shots-$run/light.png shots-$run/dark.png && { echo "light and dark look the same"; exit 1; }
done

# The counter-proof.
cat >bad.html <<'PAGE'
<!DOCTYPE html><html><head><meta name="viewport" content="width=device-width"/><title>Bad</title></head>
<body style="background:#888"><p style="color:#999;width:2000px">hard to read and wide</p>
<p style="font-size:6px">tiny</p><a href="#nowhere">lost</a>
<img src="data:image/png;base64,Zm9v"/><img src="http://pictures.invalid/x.png"/><script>nosuch()</script></body></html>
PAGE
python3 "$source/tests/cli/browser.py" bad.html shots-bad >bad.log && { echo "a bad page has passed"; exit 1; }
for fault in 'asks for http://pictures.invalid' 'the proxy was called: ' 'reports ' 'scrolls sideways: ' 'low contrast: ' 'small text: ' 'there are no curves' 'not decoded: ' \
  'no text in its place' 'leads to no place' 'the ground has'; do
  grep -q "$fault" bad.log || { echo "not found on a bad page: $fault"; cat bad.log; exit 1; }
done
echo "a page with every fault does not pass"
