# What users and developers run. Needs make and any Python >= 3.10 with venv, and nothing else.
#
#   make demo         the Panda and the one-joint arm at work: a table, and a plot in demo-output/
#   make test         everything that Carom promises, once: six minutes on two cores
#   make test-all     that and all that takes long: an hour or more; each call continues where the last one stopped;
#                     MINUTES=20 limits it, and CHANGED=1 takes the folders only that the last changes touch
#   make quick        lint and the tests that matter most, in under a minute on two cores
#   make check        lint, types and tests
#   make thorough     what takes hours: more random cases, fuzzing, long work, GPU kernels, mutations; each call
#                     continues where the last one stopped; MINUTES=20 limits it, PARTS=fuzz,soak chooses
#   make mutate       break the code on purpose, change by change, and see that tests notice; takes an hour or more
#   make mutants      the same with changes drawn by chance from every room; takes hours, and continues
#   make docs         the documentation, in site/
#   make figures      the plots of the tutorials and the pictures of the viewer, by running them; needs Chromium
#   make oracle       real PyBullet in .oracle/, which the targets below use (Python 3.11 or older)
#   make record       record what real PyBullet does in every conformance scenario
#   make surface      call every function of real PyBullet in every way and record what comes of it
#   make differ       random programs of calls, by real PyBullet and by Carom; MINUTES=20 limits it, and the next
#                     call continues
#   make conformance  compare Carom with real PyBullet, live
#   make report       the comparison as tables and plots, in docs/conformance/
#   make cluster      the tests of rollouts on several machines, which need Ray
#   make bench        speed, beside real PyBullet's, MuJoCo's, Pinocchio's and Rapier's in the same run
#   make growth       how the time of a step grows with the number of bodies: a plot in docs/
#   make learning     environment steps a second, beside SubprocVecEnv over PyBullet and EnvPool
#   make scaling      how the rate of many worlds grows with their number and the threads: a plot in docs/
#   make watching     what it costs to be watched, in a browser; needs Chromium
#   make clients      other people's tests and scripts on PyBullet and on Carom; needs git and GitHub
#   make gpu-report   compile the kernels for GPUs and say what they need of one; needs none
#   make gpu          the tests of worlds on a GPU, and how fast they are there; needs an NVIDIA GPU
#   make fuzz         a million random calls, and 100,000 damaged files of each kind
#   make soak         a million steps, thousands of loads and removals, 80,000 episodes of workers; memory must not grow
#   make from-nothing install as somebody who has nothing yet, in each way that there is; WAYS=clone names some;
#                     COMPILED=FOLDER keeps what one of them compiles, for CAROM_CACHE_PATH
#   make wheels       the wheels of all platforms, each built twice, and the source distribution: in dist/
#   make wine         step the libraries for Windows under Wine: the same bits as here
#   make aarch64      the wheel for aarch64 under emulation: conformance; needs Debian, and its qemu-user
#   make installed    the tests with the wheel alone, as a user who may write nowhere; PYTHON= names another Python
#   make oldest       the same with the oldest versions of what Carom requires
#   make clean        remove what the above have made, the recordings and reports excepted

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help

# The first of the names after $(1) that runs and satisfies the Python condition $(1).
python_where = $(shell for name in $(2); do \
	$$name -c "import sys, venv; sys.exit(not ($(1)))" 2>/dev/null && { echo $$name; break; }; done)
PYTHON ?= $(call python_where,sys.version_info >= (3$(comma) 10),python3 python3.13 python3.12 python3.11 python3.10)
ORACLE_PYTHON ?= $(call python_where,(3$(comma) 7) <= sys.version_info < (3$(comma) 12),python3.11 python3.10 python3.9 python3)
comma := ,

VENV := .venv
RUN := $(VENV)/bin/python
PIP := $(RUN) tools/patiently.py installing $(RUN) -m pip --quiet --disable-pip-version-check

.PHONY: help demo test test-all quick check thorough mutate mutants lint types docs figures oracle record surface cluster conformance differ report soak fuzz bench clients growth scaling learning watching gpu-report gpu from-nothing wheels wine aarch64 installed oldest clean

help:
	@sed -n 's/^#   //p' $(firstword $(MAKEFILE_LIST))

# --- environments: each stamp file stands for one installed set ---------------------------------

$(VENV)/created:
	@test -n "$(PYTHON)" || { echo "No Python >= 3.10 found; name one: make PYTHON=..." >&2; exit 1; }
	$(PYTHON) tools/patiently.py "making $(VENV)" $(PYTHON) -m venv $(VENV)
	@touch $@

# Without isolation: what builds the native library is installed here, and not once more for the installation,
# which builds it.
$(VENV)/carom: pyproject.toml | $(VENV)/created
	$(PIP) install $$($(RUN) tools/packaging/build_requirements.py) editables
	$(PIP) install --no-build-isolation --editable '.[plot,build]'
	@touch $@

# 230 MB are downloaded, and before them 270 MB with what Carom itself needs: mostly Warp and Zig, which compile it.
$(VENV)/test: $(VENV)/carom
	$(PIP) install --upgrade 'pip>=25.1'
	@# What is never imported need not be compiled.
	$(PIP) install --no-compile --group test
	@touch $@

# 470 MB more: PyTorch, JupyterLab, an assembler for GPUs, and what checks types and layout.
$(VENV)/dev: $(VENV)/test
	$(PIP) install --no-compile --group dev
	@touch $@

# All that is downloaded for development, without Carom: beside something else that compiles it.
$(VENV)/downloaded: pyproject.toml | $(VENV)/created
	$(PIP) install --upgrade 'pip>=25.1'
	$(PIP) install --no-compile --group dev
	@touch $@

$(VENV)/docs: $(VENV)/carom
	$(PIP) install --upgrade 'pip>=25.1'
	$(PIP) install --group docs
	@touch $@

.oracle/pybullet:
	@test -n "$(ORACLE_PYTHON)" || { echo "PyBullet needs Python <= 3.11; name one: make ORACLE_PYTHON=..." >&2; exit 1; }
	$(ORACLE_PYTHON) -m venv .oracle
	.oracle/bin/python -m pip --quiet --disable-pip-version-check install pybullet==3.2.7 numpy
	@touch $@

oracle: .oracle/pybullet

.mujoco/mujoco:
	@test -n "$(PYTHON)" || { echo "No Python >= 3.10 found; name one: make PYTHON=..." >&2; exit 1; }
	$(PYTHON) -m venv .mujoco
	.mujoco/bin/python -m pip --quiet --disable-pip-version-check install 'mujoco>=3.2,<5'
	@touch $@

# Rapier's WebAssembly, for Node.js 18 or later; `make bench` has no column of it where there is no npm.
.rapier/rapier:
	npm install --prefix .rapier --no-audit --no-fund --silent '@dimforge/rapier3d-compat@^0.21.0'
	@touch $@

.pinocchio/pin:
	@test -n "$(PYTHON)" || { echo "No Python >= 3.10 found; name one: make PYTHON=..." >&2; exit 1; }
	$(PYTHON) -m venv .pinocchio
	.pinocchio/bin/python -m pip --quiet --disable-pip-version-check install 'pin>=3,<5'
	@touch $@

# Real PyBullet's environments as Stable-Baselines3 trains on them; they were written for the `gym` of their time.
.learning/created:
	@test -n "$(ORACLE_PYTHON)" || { echo "PyBullet needs Python <= 3.11; name one: make ORACLE_PYTHON=..." >&2; exit 1; }
	$(ORACLE_PYTHON) -m venv .learning
	.learning/bin/python -m pip --quiet --disable-pip-version-check install \
		pybullet==3.2.7 'numpy<2' gym==0.23.1 'setuptools<81' 'stable-baselines3>=2.4,<3' 'torch>=2.2,<2.14'
	@touch $@

.envpool/created:
	$(PYTHON) -m venv .envpool
	.envpool/bin/python -m pip --quiet --disable-pip-version-check install 'envpool<2'
	@touch $@

# What the tests of the clients need beside the simulator. The clients themselves are not installed: they would
# bring the distribution `pybullet`.
CLIENT_NEEDS := gymnasium gym==0.26.2 scipy matplotlib pytest tqdm transforms3d control

.clients/carom/clients: pyproject.toml
	$(PYTHON) -m venv .clients/carom
	.clients/carom/bin/python -m pip --quiet --disable-pip-version-check install --editable '.[decompose,build]' $(CLIENT_NEEDS)
	@touch $@

.clients/oracle/clients:
	@test -n "$(ORACLE_PYTHON)" || { echo "PyBullet needs Python <= 3.11; name one: make ORACLE_PYTHON=..." >&2; exit 1; }
	$(ORACLE_PYTHON) -m venv .clients/oracle
	.clients/oracle/bin/python -m pip --quiet --disable-pip-version-check install pybullet==3.2.7 $(CLIENT_NEEDS)
	@touch $@

# --- what users run ------------------------------------------------------------------------------

demo: $(VENV)/carom
	$(RUN) -m carom warmup
	$(RUN) examples/demo.py

# Compiled tests are kept, also where other Python code is not: each process would compile all of them again.
PYTEST := env -u PYTHONDONTWRITEBYTECODE $(RUN) -m pytest --numprocesses auto --dist worksteal

test: $(VENV)/test
	$(RUN) -m carom warmup
	$(PYTEST)

# --- what developers run -------------------------------------------------------------------------

# What has passed is noted in build/thorough, as for `make thorough`, of which it is a part.
test-all: $(VENV)/dev
	$(RUN) -m carom warmup
	$(RUN) -m tools.thorough.run --parts $(if $(CHANGED),changed,suite) $(if $(MINUTES),--minutes $(MINUTES))

check: lint types test

# Physics, contacts and solver against closed forms; every scenario against real PyBullet; the drop-in's surface;
# layers of packages, and what the pages for developers say.
QUICK := tests/physics tests/collision tests/geometry tests/model tests/kernels tests/native/test_tables.py \
	tests/conformance/test_golden.py tests/pybullet/test_surface.py tests/pybullet/calls/test_bad_input.py \
	tests/test_world.py tests/test_body.py tests/formats/test_urdf_reader.py \
	tests/test_layers.py tests/docs/test_named_places.py tests/docs/test_statements.py

quick: lint
	$(RUN) -m carom warmup
	$(PYTEST) --quiet $(QUICK)

lint: $(VENV)/dev
	$(RUN) -m ruff check
	$(RUN) -m ruff format --check
	$(RUN) tools/page/lint.py
	$(RUN) tools/cpp_layout.py

# What is done is noted in build/thorough; parts and their pieces are in tools/thorough/parts.py.
thorough: $(VENV)/dev
	$(RUN) -m carom warmup
	$(RUN) -m tools.thorough.run $(if $(MINUTES),--minutes $(MINUTES)) $(if $(PARTS),--parts $(PARTS))

# MUTATE=rays.py for those with that in their files or texts.
mutate: $(VENV)/dev
	$(RUN) -m carom warmup
	PYTHONPATH=. $(RUN) -m tools.mutate $(MUTATE)

# ROOMS=vector,render for some rooms; MINUTES=20 limits it, and the next call continues.
mutants: $(VENV)/dev
	$(RUN) -m carom warmup
	PYTHONPATH=. $(RUN) -m tools.mutants.run $(if $(ROOMS),--rooms $(ROOMS)) $(if $(MINUTES),--minutes $(MINUTES))

types: $(VENV)/dev
	$(RUN) -m pyright
	@# Pyright looks for what it is to verify beside the first Python on the path.
	PATH="$(CURDIR)/$(VENV)/bin:$$PATH" $(RUN) -m pyright --verifytypes pybullet --ignoreexternal

# Beside real PyBullet; the recorded figures and the reports are committed.

record: oracle
	env -u PYTHONPATH .oracle/bin/python -m tests.conformance.record
	env -u PYTHONPATH .oracle/bin/python -m tests.first_contacts.record
	env -u PYTHONPATH .oracle/bin/python -m tests.soft.beside.record

surface: oracle
	env -u PYTHONPATH .oracle/bin/python -m tests.surface.record

cluster: $(VENV)/dev
	$(PIP) install --group dev --group cluster
	$(RUN) -m pytest tests/cluster

conformance: oracle $(VENV)/dev
	$(RUN) -m tests.conformance.live --oracle .oracle/bin/python

differ: oracle $(VENV)/dev
	$(RUN) -m carom warmup
	$(RUN) -m tools.differ.run --oracle .oracle/bin/python $(if $(MINUTES),--minutes $(MINUTES))
	$(RUN) -m tools.differ.run --oracle .oracle/bin/python --getters

report: $(VENV)/dev
	$(RUN) -m tests.conformance.report
	$(RUN) -m tests.first_contacts.compare
	$(RUN) -m tests.soft.beside.compare

CLIENT_SOURCES ?= .clients/sources

clients: .clients/carom/clients .clients/oracle/clients
	$(PYTHON) -m tests.clients.run --carom .clients/carom/bin/python --oracle .clients/oracle/bin/python \
		--work .clients --sources $(CLIENT_SOURCES) $(CLIENTS)

# Hatchling builds in this environment, which has what `build-system` names; so do the targets below.
# PYTHONS="python3.10 python3.13" names those to install for from a local index.
wheels: $(VENV)/dev
	$(PIP) install --group release
	PYTHONPATH=. $(RUN) -m tools.wheels.build $(foreach python,$(PYTHONS),--python $(python))

# Any Python will do, without an environment.
from-nothing:
	$(PYTHON) tools/packaging/from_nothing.py $(WAYS) $(if $(COMPILED),--compiled $(COMPILED))

OLDEST_TESTS ?= tests/conformance tests/pybullet tests/native tests/render tests/formats tests/geometry tests/model

# The Python of this machine, and the kernels of Windows in another process.
wine: $(VENV)/dev
	@command -v wine >/dev/null || { echo "needs Wine, 64 bits of it: Debian's package wine64" >&2; exit 1; }
	for level in $$($(RUN) -c "from carom.native.cpu import cpu_levels; print(*cpu_levels())"); do \
		WINEDEBUG=-all PYTHONPATH=. $(RUN) -m tools.wheels.elsewhere.run --level $$level \
			pytest -q tests/native/test_same_bits.py -k long_runs || exit; \
	done
	WINEDEBUG=-all PYTHONPATH=. $(RUN) -m tools.wheels.elsewhere.run --level v3 pytest -q tests/conformance/test_golden.py

aarch64: $(VENV)/dev
	PYTHONPATH=. $(RUN) -m tools.wheels.emulated

installed: $(VENV)/dev
	PYTHONPATH=. $(RUN) -m tools.wheels.installed --python $(PYTHON)

oldest: $(VENV)/dev
	PYTHONPATH=. $(RUN) -m tools.wheels.installed --python $(PYTHON) --oldest $(OLDEST_TESTS)

gpu-report: $(VENV)/dev
	PYTHONPATH=. $(RUN) -m tools.gpu.report

GPU ?= cuda

gpu: $(VENV)/dev
	$(RUN) benchmarks/gpu.py --device $(GPU) --counts 1024 --seconds 0.2
	CAROM_TEST_DEVICE=$(GPU) $(RUN) -m pytest tests/gpu/test_warp_device.py tests/gpu/test_soft_bodies.py
	$(RUN) benchmarks/gpu.py --device $(GPU)

fuzz: $(VENV)/dev
	$(RUN) -m tests.fuzz.api --operations 1000000
	$(RUN) -m tests.fuzz.files --cases 100000

soak: $(VENV)/dev
	$(RUN) -m tests.conformance.soak
	$(RUN) -m tests.workers.episodes

bench: oracle .mujoco/mujoco .pinocchio/pin $(if $(shell command -v npm),.rapier/rapier) $(VENV)/dev
	$(RUN) -m carom warmup
	$(RUN) benchmarks/run.py --oracle .oracle/bin/python
	$(RUN) benchmarks/throughput.py --oracle .oracle/bin/python
	$(RUN) benchmarks/batches.py
	$(RUN) benchmarks/algorithms.py
	$(RUN) benchmarks/heaps.py

scaling: $(VENV)/dev
	$(RUN) -m carom warmup
	$(RUN) benchmarks/scaling.py

growth: oracle $(VENV)/dev
	$(RUN) benchmarks/growth.py --oracle .oracle/bin/python

learning: .learning/created .envpool/created $(VENV)/dev
	$(RUN) benchmarks/environments.py

watching: $(VENV)/dev
	PYTHONPATH=. $(RUN) benchmarks/watching.py

docs: $(VENV)/docs
	$(RUN) tools/docs/drop_in.py
	$(RUN) -m mkdocs build --strict

figures: $(VENV)/dev
	$(RUN) tools/docs/plots.py
	PYTHONPATH=. $(RUN) tools/docs/viewer_pictures.py

clean:
	rm -rf $(VENV) .oracle .mujoco .pinocchio .rapier .learning .envpool .bench .clients build dist site demo-output .pytest_cache .ruff_cache .hypothesis
	find src tests examples benchmarks tools -name __pycache__ -type d -prune -exec rm -rf {} +
