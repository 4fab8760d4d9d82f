#!/usr/bin/env bash
# Runs once, when Gradescope builds the autograder's image. Submissions are linked against these libraries; the grader
# itself needs nothing. A suite with a [build] table needs the compiler.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
apt-get update -qq
apt-get install -y -qq --no-install-recommends build-essential cmake freeglut3-dev libpng-dev
