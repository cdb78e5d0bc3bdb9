//! Abaqus inputs as they come, and as they should not.

use crate::input::cloud::Fault;
use crate::input::cloud::deck::Deck;
use crate::input::cloud::mesh::{Kind, Mesh};

fn read(text: &str) -> Result<Mesh, Fault> {
    super::read(text, &mut Deck::default())
}

const FLAT: &str = "*Heading\n** a comment\n*Node\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n\
    4, 0., 1., 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n8, 0., 1., 1.\n\
    *Element, type=C3D8R, elset=cube\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n\
    *ELEMENT, TYPE=C3D4\n2, 1, 2, 3, 5\n\
    *Elset, elset=tips\n2\n*Elset, elset=all, generate\n1, 2, 1\n*Elset, elset=both\ncube, tips\n\
    *Material, name=steel\n7, 8, 9\n";

#[test]
fn elements_and_their_sets_are_read() {
    let mesh = read(FLAT).unwrap();
    assert_eq!(mesh.nodes.len(), 8);
    let kinds: Vec<Kind> = mesh.cells.iter().map(|cell| cell.kind).collect();
    assert_eq!(kinds, [Kind::Hexahedron, Kind::Tetrahedron]);
    let sets = mesh
        .parts
        .iter()
        .map(|part| (&*part.name.name, part.cells.len(), part.is_set));
    let expected = [
        ("cube", 1, false),
        ("tips", 1, true),
        ("all", 2, true),
        ("both", 2, true),
    ];
    assert_eq!(sets.collect::<Vec<_>>(), expected);
}

#[test]
fn instances_stand_where_they_are_put() {
    let part = FLAT
        .replace("*Heading\n", "*Part, name=P\n")
        .replace("*Material", "*End Part\n*Material");
    let text = format!(
        "{part}*Assembly, name=A\n*Instance, name=P-1, part=P\n*End Instance\n\
         *Instance, name=P-2, part=P\n10., 0., 0.\n10., 0., 0., 10., 0., 1., 90.\n*End Instance\n\
         *End Assembly\n"
    );
    let mesh = read(&text).unwrap();
    assert_eq!((mesh.nodes.len(), mesh.cells.len()), (16, 4));
    // (1, 0, 0) is shifted to (11, 0, 0) and turned about (10, 0, 0).
    let (_, x) = mesh.nodes[9];
    assert!(
        (x[0] - 10.0).abs() + (x[1] - 1.0).abs() + x[2].abs() < 1e-14,
        "{x:?}"
    );
    let names: Vec<&str> = mesh.parts.iter().map(|part| &*part.name.name).collect();
    assert_eq!(names[0], "P-1");
    assert!(names.contains(&"P-2.cube"));
    let corners = mesh.cells[2].corners;
    assert!(corners.iter().all(|corner| *corner > 8), "{corners:?}");
}

#[test]
fn what_cannot_be_read_is_told_with_its_line() {
    for (text, said) in [
        ("", "no Abaqus input"),
        ("solid x", "no Abaqus input"),
        (
            "*Include, input=a.inp",
            "line 1: cannot include `a.inp`: the deck is in no folder",
        ),
        ("*Include\n", "line 1: `*INCLUDE` names no file"),
        ("*Imperfection\n", "line 1: `*IMPERFECTION` is not read"),
        ("*Node, nset=a,\n", "its last keyword ends with a comma"),
        ("*Element, type=PC3D\n", "elements `PC3D` are not read"),
        (
            "*Part, name=b\n*Part, name=B\n",
            "line 2: two parts have the name `B`",
        ),
        ("*Node\n1, 0, 0, inf", "line 2: `inf` is no number"),
        ("*Node\n0, 0, 0, 0", "line 2: `0` is no number of a node"),
        ("*Node, system=C\n1, 0, 0, 0", "cylindrical or spherical"),
        ("*Element\n", "line 1: elements have no type"),
        ("*Element, type=CAX4\n", "axisymmetric elements `CAX4`"),
        ("*Element, type=C3D27\n", "elements `C3D27` are not read"),
        (
            "*Element, type=C3D4\n1, 1, 2, 3\n",
            "the last element has too few nodes",
        ),
        (
            "*Element, type=C3D4\n1, 1, 2, 3, 4, 5\n",
            "line 2: an element of 4 nodes has more",
        ),
        (
            "*Element, type=C3D4\n1, 1, 2, 3, 4\n1, 1, 2, 3, 4\n",
            "two elements have the number 1",
        ),
        ("*Elset, elset=a\nb\n", "no set `b` comes before"),
        ("*Elset, elset=a, generate\n1\n", "a range has a first"),
        ("*Instance, name=a, part=b\n", "part `b` that is not there"),
        (
            "*Part, name=b\n*End Part\n*Instance, name=a, part=b\n1, 2\n",
            "a shift of 3 numbers",
        ),
    ] {
        let words = read(text).unwrap_err().words;
        assert!(words.contains(said), "{text:?}: {words}");
    }
}

#[test]
fn names_are_the_same_in_large_and_small_letters() {
    let text = format!(
        "{FLAT}*ELEMENT,\nTYPE=C3D4,\n  elset=CUBE\n3, 1, 2, 3, 5\n*elset, elset=Both\nCube\n"
    );
    let mesh = read(&text).unwrap();
    let sets = mesh.parts.iter();
    let sets = sets.map(|part| (&*part.name.name, part.cells.len()));
    let expected = [("cube", 2), ("tips", 1), ("all", 2), ("both", 4)];
    assert_eq!(sets.collect::<Vec<_>>(), expected);
}
