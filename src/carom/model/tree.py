"""A robot as a tree of links that can be changed."""

from __future__ import annotations

from carom.description import Joint, Link, Robot


class TreeNode:
    """A link, its parent joint, and its children.

    Attributes:
        link: The link.
        index: Its index in the file.
        joint: The joint to its parent; None for the root.
        children: Its children, in the order of their joints in the file.
    """

    __slots__ = ("children", "index", "joint", "link")

    def __init__(
        self,
        link: Link,
        index: int,
        joint: Joint | None = None,
        children: list[TreeNode] | None = None,
    ) -> None:
        self.link = link
        self.index = index
        self.joint = joint
        self.children: list[TreeNode] = [] if children is None else children


def make_tree(robot: Robot) -> TreeNode:
    """The root of the tree of a robot."""
    nodes = [TreeNode(link, index) for index, link in enumerate(robot.links)]
    for joint in robot.joints:
        nodes[joint.child].joint = joint
        nodes[joint.parent].children.append(nodes[joint.child])
    return nodes[robot.root]


def depth_first(root: TreeNode) -> list[TreeNode]:
    """All nodes in depth-first order: each before its children, and each branch before the next."""
    order: list[TreeNode] = []
    pending = [root]
    while pending:
        node = pending.pop()
        order.append(node)
        pending.extend(reversed(node.children))
    return order


def file_order(root: TreeNode) -> list[TreeNode]:
    """All nodes in the order of the file, except that each comes after its parent."""
    # Few callers ask for this order.
    import heapq

    order: list[TreeNode] = []
    ready = [(root.index, root)]
    while ready:
        _, node = heapq.heappop(ready)
        order.append(node)
        for child in node.children:
            heapq.heappush(ready, (child.index, child))
    return order
