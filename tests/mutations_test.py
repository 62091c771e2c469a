"""The list of mutations follows the source: every text stands there exactly once."""
import subprocess
import sys
from pathlib import Path

script = Path(sys.argv[1]) / "tests" / "mutation.py"
sys.exit(subprocess.run([sys.executable, "-B", str(script), "--check"], check=False).returncode)
