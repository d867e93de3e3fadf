# The JSON Schema accepts the cases that ship and refuses common mistakes.
# usage: schema.py PROGRAM CASES_FOLDER; PROGRAM --schema prints the schema. Exit 77 without PyYAML.
# Uses python3-jsonschema where it is installed, else the small validator below (the keywords that
# the schema uses, and no others).
import glob, json, re, subprocess, sys

try:
    import yaml
except ImportError:
    sys.exit(77)


def fits_type(value, name):
    kinds = {"object": dict, "array": list, "string": str}
    if name == "number":
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    return isinstance(value, kinds[name])


def problems(value, schema, root, at="case"):
    known = {"$schema", "$defs", "title", "description", "$ref", "type", "enum", "const", "pattern", "minimum",
             "maximum", "exclusiveMinimum", "exclusiveMaximum", "anyOf", "allOf", "if", "then",
             "properties", "required", "additionalProperties", "propertyNames", "minProperties", "items",
             "minItems", "maxItems"}
    assert set(schema) <= known, set(schema) - known
    found = []
    if "$ref" in schema:
        part = root
        for name in schema["$ref"].split("/")[1:]:
            part = part[name]
        found += problems(value, part, root, at)
    if "type" in schema:
        names = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        if not any(fits_type(value, n) for n in names):
            return found + [f"{at}: {value!r} is not of type {names}"]
    if "enum" in schema and value not in schema["enum"]:
        found.append(f"{at}: {value!r} is none of {schema['enum']}")
    if "const" in schema and value != schema["const"]:
        found.append(f"{at}: {value!r} is not {schema['const']}")
    if isinstance(value, str) and "pattern" in schema and not re.search(schema["pattern"], value):
        found.append(f"{at}: {value!r} does not fit {schema['pattern']}")
    if fits_type(value, "number"):
        if (value < schema.get("minimum", value) or value > schema.get("maximum", value)
                or ("exclusiveMinimum" in schema and value <= schema["exclusiveMinimum"])
                or ("exclusiveMaximum" in schema and value >= schema["exclusiveMaximum"])):
            found.append(f"{at}: {value} is out of range")
    if "anyOf" in schema:
        tries = [problems(value, s, root, at) for s in schema["anyOf"]]
        if all(tries):
            found += [p for t in tries for p in t]
    for s in schema.get("allOf", []):
        found += problems(value, s, root, at)
    if "if" in schema and not problems(value, schema["if"], root, at):
        found += problems(value, schema["then"], root, at)
    if isinstance(value, list):
        if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
            found.append(f"{at}: {len(value)} entries")
        for i, v in enumerate(value):
            found += problems(v, schema.get("items", {}), root, f"{at}[{i}]")
    if isinstance(value, dict):
        if len(value) < schema.get("minProperties", 0):
            found.append(f"{at}: is empty")
        found += [f"{at}: needs {k}" for k in schema.get("required", []) if k not in value]
        for k, v in value.items():
            if "propertyNames" in schema:
                found += problems(k, schema["propertyNames"], root, f"{at}.{k}")
            if k in schema.get("properties", {}):
                found += problems(v, schema["properties"][k], root, f"{at}.{k}")
            elif schema.get("additionalProperties", True) is False:
                found.append(f"{at}: unknown key {k}")
            elif isinstance(schema.get("additionalProperties"), dict):
                found += problems(v, schema["additionalProperties"], root, f"{at}.{k}")
    return found


def judge(value, schema):
    try:
        import jsonschema
        return [e.message for e in jsonschema.Draft202012Validator(schema).iter_errors(value)]
    except (ImportError, AttributeError):
        return problems(value, schema, schema)


base = yaml.safe_load("{end: 1 ms, mesh: a.geo, materials: {r: {young: 3 GPa, poisson: 0.3, density: 2700}}}")
wrong = [
    "{thicknes: 1}", "{thickness: [1]}", "{thickness: nan}", "{thickness: GPa}", "{thickness: -1}",
    "{thickness: 1 000}", "{analysis: statik}", "{gravity: 9.81}", "{gravity: [1, 2, 3, 4]}", "{quiet: []}",
    "{supports: {group: a}}", "{supports: [{displacement: {x: 0}}]}", "{supports: [{group: a, displacement: {w: 0}}]}",
    "{supports: [{group: a, displacement: {}}]}", "{loads: [{group: a, traction: {rotation: 1}}]}",
    "{loads: [{group: a, pressure: {ramp: 1}}]}", "{loads: [{group: a, pressure: {table: [[1]]}}]}",
    "{mesh: {fil: a}}", "{mesh: [a]}", "{materials: {r: {poisson: 0.3}}}",
    "{materials: {r: {model: orthotropic, young: 1, poisson: 0}}}", "{materials: {'a b': {young: 1, poisson: 0}}}",
    "{contact: {active: maybe}}", "{probes: {p: {group: a, quantity: size}}}", "{safety: 2}",
    "{grains: {dimension: 2}}", "{grains: {dimension: 4, materials: {}}}", "{contacts: [{frction: 1}]}", "{walls: {w: {normal: [0, 1]}}}",
]
right = [
    "{}", "{thickness: 5 cm}", "{thickness: '.5e-3'}", "{mass_damping: 200 1/s}", "{gravity: [0, -9.81 m/s2]}",
    "{quiet: a}", "{contact: no}", "{contact: {}}", "{supports: [{group: 7, displacement: {x: 0, rotation: 1}}]}",
    "{loads: [{group: a, pressure: {sine: 1, frequency: 5 Hz}}, {group: a, pressure: {table: [[0, 1], [1 s, 2]]}}]}",
    "{mesh: {shape: hex8, count: [1, 1, 1], size: [1, 1, 1 mm]}}",
    "{grains: {dimension: 2, packing: {kind: loose, high: [1, 1]}, materials: {s: {density: 1}}}, contacts: [{friction: 1}]}",
    "{walls: {w: {shape: plane, normal: [0, 1], velocity: {y: 1}}}, cell: {rate: {xx: {ramp: 1, over: 1}}}}",
    "{materials: {r: {model: cosserat, young: 1, poisson: 0, cosserat_modulus: 1, characteristic_length: 1}}}",
]

schema = json.loads(subprocess.run([sys.argv[1], "--schema"], check=True, stdout=subprocess.PIPE).stdout)
failed = False
for text in right:
    found = judge({**base, **yaml.safe_load(text)}, schema)
    if found:
        failed = True
        print(f"{text} is refused: {found[:3]}")
for text in wrong:
    if not judge({**base, **yaml.safe_load(text)}, schema):
        failed = True
        print(f"{text} is accepted")
for path in sorted(glob.glob(sys.argv[2] + "/**/*.yaml", recursive=True)):
    with open(path) as file:
        found = judge(yaml.safe_load(file), schema)
    if found:
        failed = True
        print(f"{path} is refused: {found[:3]}")
sys.exit(1 if failed else 0)
