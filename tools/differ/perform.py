"""Performs programs with whichever `pybullet` the interpreter that runs this has; needs Python 3.7 alone.

As a script it is a server: from each line of the standard input it reads an order in JSON, `{"calls",
"data", "timeout"}`, and writes a line `{"results", "died"}`. Each program runs in a process of its own,
forked, so that one which crashes or hangs ends by itself; `died` says how, and is null for those that
came to their end.

The result of a call is `["ok", value]`, `["error", type, text]`, or `["lost"]` where it refers to a call
that failed.
"""

# ruff: noqa: B905  (`zip` has no `strict` before Python 3.10)
import json
import os
import select
import signal
import sys
import time
from random import Random

import pybullet as p

MAX_JOINTS = 64
"""So many joints of a body are in `@probe`."""
AT_LIMIT = 5e-15
"""So near to a limit a joint is at it, as far as rounding lets one tell."""
FAR = [1000.0, 1000.0, 1000.0]
# Groups and masks of what moves, and of bases that do not.
MOVING, STATIC = (1, -1), (2, -3)


def serve(performed=None):
    """Answer orders until the standard input ends, each by what performs it: `in_a_process` if left out."""
    performed = performed or in_a_process
    answers = os.fdopen(os.dup(1), "w")
    # What PyBullet prints is in nobody's way.
    silence = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    for line in sys.stdin:
        order = json.loads(line)
        if "warm" in order:
            warm(order["warm"], order["data"])
            answer = {}
        else:
            answer = performed(order)
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


def warm(files, data):
    """Load files once, so that the forked processes find them in caches."""
    client = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(data)
    for name in files:
        try:
            p.loadURDF(name)
            p.resetSimulation()
        except p.error:
            pass
    p.disconnect(client)


def in_a_process(order):
    """What came of a program, performed in a process of its own."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        status = 1
        try:
            with os.fdopen(writing, "w") as pipe:
                for result in perform(order["calls"], order["data"]):
                    pipe.write(json.dumps(result) + "\n")
                    pipe.flush()
            status = 0
        finally:
            os._exit(status)
    os.close(writing)
    text, died, until = b"", None, time.monotonic() + order["timeout"]
    while died is None:
        if not select.select([reading], [], [], max(until - time.monotonic(), 0))[0]:
            os.kill(child, signal.SIGKILL)
            died = "timeout"
        else:
            piece = os.read(reading, 1 << 16)
            text += piece
            if not piece:
                break
    os.close(reading)
    status = os.waitpid(child, 0)[1]
    if died is None and os.WIFSIGNALED(status):
        died = f"signal {os.WTERMSIG(status)}"
    elif died is None and status:
        died = f"status {os.WEXITSTATUS(status)}"
    return {"results": whole_lines(text), "died": died}


def whole_lines(text):
    """The results that were written; the last line of a process that died may be half of one."""
    results = []
    for line in text.split(b"\n"):
        try:
            results.append(json.loads(line))
        except ValueError:
            break
    return results


def perform(calls, data):
    """The results of a program's calls, one by one, in a connection of its own."""
    client = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(data)
    known = {}
    try:
        for call in calls:
            yield result_of(call, known)
    finally:
        p.disconnect(client)


def result_of(call, known):
    """What came of a call; what it returns is kept for later ones."""
    try:
        arguments = [filled(argument, known) for argument in call["a"]]
        keywords = {name: filled(argument, known) for name, argument in call["k"].items()}
    except (KeyError, IndexError, TypeError):
        return ["lost"]
    try:
        function = OWN.get(call["f"]) or getattr(p, call["f"])
        value = known[call["id"]] = function(*arguments, **keywords)
        return ["ok", plain(value)]
    except Exception as error:
        return ["error", type(error).__name__, str(error)[:300]]


def filled(argument, known):
    """An argument with results in place of references."""
    if isinstance(argument, list):
        return [filled(part, known) for part in argument]
    if not isinstance(argument, dict):
        return argument
    if "whole" in argument:
        return known[argument["whole"]]
    value = known[argument["$"]]
    if "i" in argument:
        value = value[argument["i"]]
    if not isinstance(value, int) or value < 0:
        raise KeyError(argument["$"])
    return value


def plain(value):
    """A result as JSON has it."""
    if isinstance(value, bytes):
        return value.decode(errors="replace")
    if isinstance(value, (tuple, list)):
        return [plain(part) for part in value]
    if isinstance(value, dict):
        return {str(name): plain(part) for name, part in value.items()}
    if hasattr(value, "tolist"):
        return value.tolist()
    return value


def probe():
    """The state of all bodies, how many contact points there are, and the least of their distances.

    A body is its id, its base (pose and velocity), positions and velocities of its joints, and their
    reactions and torques.
    """
    bodies = []
    for body in sorted(p.getBodyUniqueId(place) for place in range(p.getNumBodies())):
        try:
            base = [*p.getBasePositionAndOrientation(body), *p.getBaseVelocity(body)]
        except p.error:
            base = []
        joints = range(min(p.getNumJoints(body), MAX_JOINTS))
        states = [p.getJointStateMultiDof(body, joint) for joint in joints]
        reactions = [
            p.getJointState(body, joint)[2:] if len(state[0]) < 2 else state[2:4]
            for joint, state in zip(joints, states)
        ]
        positions, velocities = [state[0] for state in states], [state[1] for state in states]
        bodies.append([body, *map(plain, (base, positions, velocities, reactions))])
    contacts = p.getContactPoints() or ()
    return [bodies, len(contacts), min((point[8] for point in contacts), default=0.0)]


def reach(body, links, answer, targets, turn):
    """An answer of inverse kinematics: how far from all targets, by which angle turned, and the answer."""
    joints = [joint for joint in range(p.getNumJoints(body)) if p.getJointInfo(body, joint)[3] >= 0]
    before = [p.getJointState(body, joint)[:2] for joint in joints]
    for joint, position in zip(joints, answer):
        p.resetJointState(body, joint, position)
    states: list = [p.getLinkState(body, link, computeForwardKinematics=1) for link in links]
    for joint, (position, velocity) in zip(joints, before):
        p.resetJointState(body, joint, position, velocity)
    far = sum((a - b) ** 2 for state, target in zip(states, targets) for a, b in zip(state[4], target)) ** 0.5
    angle = 0.0
    if turn is not None:
        angle = abs(p.getAxisAngleFromQuaternion(p.getDifferenceQuaternion(states[0][1], turn))[1])
        angle = min(angle, 2 * 3.141592653589793 - angle)
    return [far, angle, list(answer)]


def nudge(distance, seed, side):
    """Put joints that are at a limit so far to one side of it.

    They stay where they are if `side` is 0; they lie beyond the limit if it is 1, before it if it is -1, and
    each on either side, as the seed has it, if it is null. Each joint is reset in any case.
    """
    random = Random(seed)
    for body in sorted(p.getBodyUniqueId(place) for place in range(p.getNumBodies())):
        for joint in range(p.getNumJoints(body)):
            said = p.getJointInfo(body, joint)
            if said[2] not in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC):
                continue
            position, velocity = p.getJointState(body, joint)[:2]
            lower, upper = said[8:10]
            if lower <= upper:
                beyond = (abs(position - upper) <= AT_LIMIT) - (abs(position - lower) <= AT_LIMIT)
                position += beyond * distance * (random.choice((-1, 1)) if side is None else side)
            p.resetJointState(body, joint, position, velocity)


def push(body, way):
    """Put a body so far aside, along its own axes."""
    pose = p.multiplyTransforms(*p.getBasePositionAndOrientation(body), way, [0, 0, 0, 1])
    p.resetBasePositionAndOrientation(body, *pose)


def search(times):
    """Move a body to and fro, far from all others, and look for pairs each time; it is removed again."""
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    body = p.createMultiBody(0, shape, -1, FAR)
    for count in range(times):
        p.resetBasePositionAndOrientation(body, [*FAR[:2], FAR[2] + count % 2], [0, 0, 0, 1])
        p.performCollisionDetection()
    p.removeBody(body)
    p.removeCollisionShape(shape)


def pass_bare_links():
    """Let links without shapes meet nothing, and look for what the others meet, one after the other, anew."""
    for body in sorted(p.getBodyUniqueId(place) for place in range(p.getNumBodies())):
        for link in range(-1, p.getNumJoints(body)):
            group, mask = STATIC if link < 0 and not p.getDynamicsInfo(body, link)[0] else MOVING
            if not p.getCollisionShapeData(body, link):
                group, mask = 0, 0
            p.setCollisionFilterGroupMask(body, link, group, mask)


def pass_tied_links():
    """Let links of a body that fixed joints tie to each other not touch."""
    for body in sorted(p.getBodyUniqueId(place) for place in range(p.getNumBodies())):
        first = [-1]
        for link in range(p.getNumJoints(body)):
            said = p.getJointInfo(body, link)
            fixed = said[2] == p.JOINT_FIXED and said[16] < link
            first.insert(link, first[said[16]] if fixed else link)
        for link in range(len(first) - 1):
            for other in range(-1, link):
                if first[other] == first[link]:
                    p.setCollisionFilterPair(body, body, link, other, 0)


def digits_lost():
    """Of each body how many times its least moment of inertia the mass is times its distance squared."""
    found = []
    for body in sorted(p.getBodyUniqueId(place) for place in range(p.getNumBodies())):
        centre, least, most = p.getBasePositionAndOrientation(body)[0], float("inf"), 0.0
        for link in range(-1, p.getNumJoints(body)):
            mass, _, moments = p.getDynamicsInfo(body, link)[:3]
            if mass > 0:
                least = min([least, *(moment for moment in moments if moment > 0)])
                place = p.getLinkState(body, link)[0] if link >= 0 else centre
                most = max(most, mass * sum((a - b) ** 2 for a, b in zip(place, centre)))
        found.append(most / least)
    return found


OWN = {
    "@probe": probe,
    "@reach": reach,
    "@nudge": nudge,
    "@push": push,
    "@search": search,
    "@pass_bare_links": pass_bare_links,
    "@pass_tied_links": pass_tied_links,
    "@digits_lost": digits_lost,
}

if __name__ == "__main__":
    serve()
