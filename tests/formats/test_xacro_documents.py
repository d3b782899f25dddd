"""Documents of xacro: as xacro 2.1.1 expands them, except for `$(eval)` and packages that are not found."""

from __future__ import annotations

import pytest

from carom import World
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.files.xml_tree import parse_xml
from carom.formats.search import AssetSearch
from carom.formats.xacro import expand, is_xacro

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
INCLUDED = (
    f'{HEAD}<xacro:property name="p" value="inc"/>'
    '<xacro:macro name="m" params="v"><l v="${v}" p="${p}"/></xacro:macro><z/></robot>'
)


def shown(element: Element) -> str:
    """An element and all inside it as a short text."""
    attributes = "".join(f" {name}={value}" for name, value in element.attributes.items())
    inside = " ".join([element.text.strip(), *map(shown, element.children)]).strip()
    return f"<{element.tag}{attributes}{' ' + inside if inside else ''}>"


@pytest.fixture
def expanded(tmp_path):
    def work(body: str, **arguments: str) -> str:
        file = tmp_path / "robot.xacro"
        file.write_text(f"{HEAD}{body}</robot>")
        root = expand(parse_xml(file.read_bytes(), file)[0], file, AssetSearch(packages=()), arguments).root
        return " ".join(map(shown, root.children))

    (tmp_path / "inc.txt").write_text(INCLUDED)
    return work


def macro(parameters: str, body: str) -> str:
    return f'<xacro:macro name="m" params="{parameters}">{body}</xacro:macro>'


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<l a="${1+1}" b="x${2}y" c="${1.0}" d="${True}" e="${[1]}"/>', "<l a=2 b=x2y c=1.0 d=True e=[1]>"),
        ('<l a="$${x}" b="$$(x)" c="$$$${x}" d="a$b"/>', "<l a=${x} b=$(x) c=$$${x} d=a$b>"),
        # Properties are evaluated when they are first used.
        (
            '<xacro:property name="a" value="${b+1}"/><xacro:property name="b" value="2"/><l a="${a}"/>'
            '<xacro:property name="b" value="10"/><l a="${a}"/>',
            "<l a=3> <l a=3>",
        ),
        (
            '<xacro:property name="p" value="1"/>'
            '<xacro:property name="p" value="${p+1}" lazy_eval="false"/><l p="${p}"/>',
            "<l p=2>",
        ),
        (
            '<xacro:property name="a" default="1"/><xacro:property name="a" default="2"/><l a="${a}"/>',
            "<l a=1>",
        ),
        (macro("", '<xacro:property name="p" value="2" scope="parent"/>'
                   '<xacro:property name="g" value="3" scope="global"/>')
         + '<xacro:m/><l a="${p+g}"/>', "<l a=5>"),
        (macro("a b:=2 c:='x y' d:=${ 1 + 2 }", '<l a="${a}" b="${b}" c="${c}" d="${d}"/>')
         + '<xacro:m a="1"/>', "<l a=1 b=2 c=x y d=3>"),
        # Defaults see what is around the call.
        ('<xacro:property name="a" value="top"/>' + macro("a b:=${a}", '<l b="${b}"/>') + '<xacro:m a="3"/>',
         "<l b=top>"),
        ('<xacro:property name="p" value="5"/>' + macro("p:=^ q:=^|9", '<l p="${p}" q="${q}"/>')
         + '<xacro:m/><xacro:m p="1" q="2"/>', "<l p=5 q=9> <l p=1 q=2>"),
        (macro("n *o **i", '<x n="${n}"><xacro:insert_block name="o"/><xacro:insert_block name="i"/></x>')
         + '<xacro:property name="n" value="out"/><xacro:m n="1"><o a="${n}"/><i><p/><q/></i></xacro:m>',
         "<x n=1 <o a=out> <p> <q>>"),
        # The elements of a property are expanded where they are inserted.
        ('<xacro:property name="o"><q v="${v}"/></xacro:property>'
         + macro("v", '<xacro:insert_block name="o"/>') + '<xacro:m v="3"/>', "<q v=3>"),
        ('<xacro:if value="1"><a/></xacro:if><xacro:if value="false"><b/></xacro:if>'
         "<xacro:unless value=\"${'a' == 'b'}\"><c/></xacro:unless>", "<a> <c>"),
        ('<xacro:arg name="a" default="5"/><xacro:arg name="b" default="$(arg a)1"/>'
         "<l a=\"$(arg a)\" b=\"${$(arg b)+1}\" c=\"${xacro.arg('a')}\"/>", "<l a=5 b=52 c=5>"),
        (macro("n", '<l n="${n}"/><xacro:if value="${n > 0}"><xacro:m n="${n-1}"/></xacro:if>')
         + '<xacro:m n="2"/>', "<l n=2> <l n=1> <l n=0>"),
        (macro("v", '<l v="${v}"/>') + '<xacro:property name="k" value="m"/><xacro:call macro="${k}" v="1"/>',
         "<l v=1>"),
        ('<xacro:element xacro:name="foo${1+1}" a="${2}"><b/></xacro:element>', "<foo2 a=2 <b>>"),
        ('<x><xacro:attribute name="q" value="${1+2}"/></x>', "<x q=3>"),
        ("<x>a ${1+1} b</x>", "<x a 2 b>"),
        ('<x>pre<xacro:if value="1">foo</xacro:if></x>', "<x prefoo>"),
        ('<xacro:include filename="inc.txt"/><xacro:m v="1"/>', "<z> <l v=1 p=inc>"),
        ('<xacro:property name="p" value="out"/><xacro:include filename="inc.txt" ns="k"/>'
         '<x a="${k.p} ${p}"/><xacro:k.m v="1"/>', "<z> <x a=inc out> <l v=1 p=inc>"),
        ('<xacro:include filename="none.txt" optional="true"/><x/>', "<x>"),
        ('<xacro:include filename="in*.txt"/>', "<z>"),
        ('<l a="[$(optenv CAROM_NOT_SET a b)]" b="[$(optenv CAROM_NOT_SET)]"/>', "<l a=[a b] b=[]>"),
        ("<l a=\"$(eval 1 + 1)\"/>", "<l a=2>"),
        ('<l f="file://$(find nowhere)/a.stl"/>', "<l f=package://nowhere/a.stl>"),
    ],
)  # fmt: skip
def test_expansion(expanded, body, expected):
    assert expanded(body) == expected


@pytest.mark.parametrize(
    ("body", "complaint"),
    [
        ("<xacro:leg/>", r":1: <xacro:leg>: there is no macro 'leg'"),
        (macro("a", "") + "\n<xacro:m/>", r":2: <xacro:m>: macro 'm' needs a value for 'a'"),
        (macro("a", "") + '\n<xacro:m a="1" b="2"/>', r":2: .*no parameter 'b'; it has a"),
        (macro("*o", "") + "\n<xacro:m/>", r":2: .*needs an element for block 'o'"),
        (macro("", "") + "\n<xacro:m><q/></xacro:m>", r":2: .*no block for <q>"),
        (
            macro("a", '\n<l b="${a / 0}"/>') + '\n<xacro:m a="1"/>',
            r"robot.xacro:2: <l>: attribute 'b': .*division by zero \(in macro 'm' called at .*xacro:3\)",
        ),
        (
            '<xacro:property name="a" value="${b}"/><xacro:property name="b" value="${a}"/><l a="${a}"/>',
            r"circle: a -> b -> a",
        ),
        ('<l a="$(arg size)"/>', r"give it by xacro_args=\{'size'"),
        ('<xacro:if value="maybe"/>', r"'maybe' is neither true nor false"),
        ('<xacro:if test="1"/>', r"attribute 'test' is not known; there are value"),
        ('<xacro:include filename="none.txt"/>', r"there is no file 'none.txt'"),
        ('<xacro:include filename="$(find arm)/x.xacro"/>', r"give its folder by package_paths="),
        ('<xacro:include filename="robot.xacro"/>', r"includes itself"),
        ('<xacro:property name="a-b" value="1"/>', r"cannot be the name"),
        ('<l a="$(env CAROM_NOT_SET)"/>', r"'CAROM_NOT_SET' is not set"),
        ('<l a="$(anon x)"/>', r"\$\(anon x\) is not known"),
        ('<l a="${1"/>', r"never closed"),
        ('<xacro:insert_block name="o"/>', r"there is no block 'o'"),
        ("${xacro.load_yaml('none.yaml')}", r"no YAML file 'none.yaml'"),
        ("${xacro.fatal('wrong arm')}", r"wrong arm"),
        # Macros without an end, and macros that double what they are given.
        (macro("", "<xacro:m/>") + "<xacro:m/>", r"nested deeper than"),
        (
            macro("n **o", '<xacro:if value="${n}"><xacro:m n="${n-1}"><i><xacro:insert_block name="o"/>'
                           '<xacro:insert_block name="o"/></i></xacro:m></xacro:if>')
            + '<xacro:m n="50"><i><q/></i></xacro:m>', r"more than \d+ elements",
        ),
        ('<xacro:property name="t" value="${\'x\' * 900000}"/>' + '<l a="${t}"/>' * 30,
         r"more than \d+ characters"),
        (
            "".join(f'<xacro:property name="p{i}" value="${{p{i + 1}}}"/>' for i in range(60))
            + "<l>${p0}</l>",
            r"more than \d+ properties",
        ),
    ],
)  # fmt: skip
def test_errors_name_file_line_and_calls(expanded, body, complaint):
    with pytest.raises(DescriptionError, match=complaint):
        expanded(body)


def test_yaml_files(expanded, tmp_path):
    (tmp_path / "arm.yaml").write_text("arm: {length: 2, limits: [!degrees 180, !radians pi]}\nname: a\n")
    body = (
        "<xacro:property name='c' value=\"${xacro.load_yaml('arm.yaml')}\"/>"
        '<l a="${c[\'arm\'][\'length\']}" b="${c.arm.limits[0] == c.arm.limits[1] == pi}" n="${c.name}"/>'
    )
    try:
        import yaml  # noqa: F401  # pyright: ignore
    except ImportError:
        with pytest.raises(DescriptionError, match=r"pip install 'carom\[xacro\]'"):
            expanded(body)
    else:
        assert expanded(body) == "<l a=2 b=True n=a>"


def test_which_files_are_expanded(tmp_path):
    def judged(text: str, name: str = "r.urdf") -> bool:
        return is_xacro(parse_xml(text.encode(), tmp_path / name)[0], tmp_path / name)

    assert judged(f"{HEAD}<xacro:m/></robot>")
    assert judged(f'{HEAD}<l a="${{1}}"/></robot>')
    assert judged('<robot><l a="${1}"/></robot>', "r.xacro")
    # What xacro has made declares its namespace still.
    assert not judged(f'{HEAD}<l a="1"/></robot>')
    assert not judged('<robot><l a="${1}"/></robot>')


LEG = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="leg" params="prefix mass">
    <link name="${prefix}leg"><inertial><mass value="${mass}"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="${prefix}hip" type="revolute"><parent link="base"/><child link="${prefix}leg"/>
      <axis xyz="0 0 1"/><limit lower="${-pi / 2}" upper="${pi/2}" effort="1" velocity="1"/>
      <colour/></joint>
  </xacro:macro>
</robot>
"""
ROBOT = """<robot name="walker" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="mass" default="2"/>
  <xacro:arg name="two" default="true"/>
  <xacro:include filename="$(find walker_parts)/urdf/leg.xacro"/>
  <link name="base"/>
  <xacro:leg prefix="l_" mass="$(arg mass)"/>
  <xacro:if value="$(arg two)">
    <xacro:leg prefix="r_" mass="${2 * $(arg mass)}"/>
  </xacro:if>
</robot>
"""


@pytest.fixture
def walker(tmp_path):
    (tmp_path / "src" / "walker" / "urdf").mkdir(parents=True)
    (tmp_path / "src" / "parts" / "urdf").mkdir(parents=True)
    (tmp_path / "src" / "parts" / "package.xml").write_text("<package><name>walker_parts</name></package>")
    (tmp_path / "src" / "parts" / "urdf" / "leg.xacro").write_text(LEG)
    robot = tmp_path / "src" / "walker" / "urdf" / "walker.urdf.xacro"
    robot.write_text(ROBOT)
    return robot


def test_a_world_loads_a_file_of_macros(walker):
    leg = walker.parents[2] / "parts" / "urdf" / "leg.xacro"
    packages = [walker.parents[2] / "parts"]
    with World() as world:
        scene = world.load(walker, package_paths=packages)
        assert scene.format == "URDF"
        assert [link.name for link in scene["walker"].links] == ["base", "l_leg", "r_leg"]
        assert [link.mass for link in scene["walker"].links][1:] == [2.0, 4.0]
        (ignored,) = [one for one in scene.ignored if one.element == "joint/colour"]
        assert (ignored.file, ignored.line, ignored.count) == (leg, 7, 2)
        other = world.load(walker, package_paths=packages, xacro_args={"mass": 5, "two": False})
        assert [link.mass for link in other[0].links][1:] == [5.0]
        with pytest.raises(ValueError, match="no argument 'weight' for xacro_args; its arguments: mass, two"):
            world.load(walker, package_paths=packages, xacro_args={"weight": 1})
        with pytest.raises(ValueError, match="is no xacro file"):
            world.load("cube_small.urdf", xacro_args={"mass": 1})


def test_a_changed_include_is_read_again(walker):
    leg = walker.parents[2] / "parts" / "urdf" / "leg.xacro"
    packages = [walker.parents[2] / "parts"]
    with World() as world:
        world.load(walker, package_paths=packages)
        leg.write_text(LEG.replace('value="${mass}"', 'value="${mass + 1}"'))
        scene = world.load(walker, package_paths=packages)
        assert [link.mass for link in scene[0].links][1:] == [3.0, 5.0]


def test_errors_in_what_macros_made_name_the_macro_and_the_call(walker):
    leg = walker.parents[2] / "parts" / "urdf" / "leg.xacro"
    with World() as world:
        complaint = rf"{leg}:3: .* > <mass>: .*\(in macro 'leg' called at {walker}:6\)"
        with pytest.raises(DescriptionError, match=complaint):
            world.load(walker, package_paths=[leg.parents[1]], xacro_args={"mass": "heavy", "two": False})
        assert not world.bodies


def test_packages_are_found_beside_the_folders_above(walker):
    parts = walker.parents[2] / "parts"
    parts.rename(parts.with_name("walker_parts"))
    with World() as world:
        assert len(world.load(walker)[0].links) == 3


def test_models_of_sdf_may_have_macros(tmp_path):
    file = tmp_path / "m.sdf"
    file.write_text(
        '<sdf version="1.6" xmlns:xacro="x"><xacro:arg name="h" default="1"/>'
        '<model name="m"><pose>0 0 ${2 * $(arg h)} 0 0 0</pose><link name="l"/></model></sdf>'
    )
    with World() as world:
        body = world.load(file, xacro_args={"h": 3})[0]
        assert body.links[-1].pose.position[2] == 6.0
