"""A flow of `benches/flow_limits.rs`, whose values get the names of quantities.

`flow_limits.py '{"flow": "swing", "across": 20, "names": {"decay": "decay of the swing"}}'`
"""

import json
import subprocess
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2]))

from built import newest  # noqa: E402 - of the folder of all benches


def main() -> None:
    asked = json.loads(sys.argv[1])
    names = asked.pop("names")
    command = [newest("flow_limits"), json.dumps(asked)]
    ran = subprocess.run(command, check=True, capture_output=True, text=True)
    told = json.loads(ran.stdout)
    if told["failure"]:
        raise SystemExit(told["failure"])
    told["values"] = {names[key]: told["values"][key] for key in names}
    print(json.dumps(told))


if __name__ == "__main__":
    main()
