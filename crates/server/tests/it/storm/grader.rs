//! A grader for storms: a script that replaces `fosssim-oracle` and follows the instructions in the submission. The
//! real worker runs it as its child.
use std::{
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};

/// A submission is one line: the instruction, the verdict's code, the points, and the duration.
///
/// `poison` kills the worker that runs it, every time. `crash` kills the grader. `freeze` stops its worker the first
/// time, and the test continues that worker much later.
const SCRIPT: &str = r#"#!/bin/sh
[ "$1" = grade ] || exit 2
program=$2
while [ $# -gt 0 ]; do
    case $1 in
        json=*) json=${1#json=} ;;
        text=*) text=${1#text=} ;;
    esac
    shift
done
read -r kind code points seconds < "$program"
case $kind in
    poison) kill -KILL $PPID; sleep 60 ;;
    crash) kill -SEGV $$ ;;
    freeze) mkdir "$0.frozen.$(basename "$program")" 2>/dev/null && kill -STOP $PPID ;;
esac
sleep "$seconds"
echo "report on $(basename "$program"): $code" > "$text"
cat > "$json" <<END
{"schema": 4, "version": "storm", "grades": [{"verdict": "in words", "code": "$code", "points": $points,
 "max_points": 100, "groups": [{"scenes": [{"code": "$code"}]}]}]}
END
[ "$code" = AC ]
"#;

/// Writes the script into a folder.
pub(super) fn write(folder: &Path) -> PathBuf {
    let path = folder.join("storm-grader");
    fs::write(&path, SCRIPT).expect("a script");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("permissions");
    path
}
