//! LS-DYNA decks as they come, and as they should not.

use super::*;

fn read(text: &str) -> Result<Mesh, Fault> {
    super::read(text, &mut Deck::default())
}

const DECK: &str = "*KEYWORD\n*PART\n$ a comment\nsphere\n         7         1         1\n*NODE\n\
    \x20      1              0.              0.              0.\n\
    \x20      2           1.0d0              0.              0.       0       0\n\
    3, 1, 1, 0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
    *ELEMENT_SOLID (ten nodes format)\n\
    \x20      1       7\n\
    \x20      1       2       3       4       5       6       7       8       0       0\n\
    *ELEMENT_SOLID\n\
    \x20      2       8       1       2       3       5       5       5       5       5\n\
    *ELEMENT_SPH\n       1       9          2.5e-3\n*MAT_ELASTIC\n1,2,3\n*END\nnonsense";

#[test]
fn both_formats_of_cards_are_read() {
    let mesh = read(DECK).unwrap();
    assert_eq!(mesh.nodes.len(), 8);
    assert_eq!(mesh.nodes[1], (2, [1.0, 0.0, 0.0]));
    let kinds: Vec<Kind> = mesh.cells.iter().map(|cell| cell.kind).collect();
    assert_eq!(kinds, [Kind::Hexahedron, Kind::Tetrahedron]);
    assert_eq!(mesh.points[0].mass, 2.5e-3);
    let parts = mesh
        .parts
        .iter()
        .map(|part| (part.name.number, &*part.name.name));
    assert_eq!(
        parts.collect::<Vec<_>>(),
        [(Some(7), "sphere"), (Some(8), ""), (Some(9), "")]
    );
}

#[test]
fn what_cannot_be_read_is_told_with_its_line() {
    for (text, said) in [
        ("", "no LS-DYNA file"),
        ("solid x\n", "no LS-DYNA file"),
        ("*KEYWORD LONG=Y\n", "line 1: the long format"),
        (
            "*INCLUDE\nmesh.k\n",
            "line 2: cannot include `mesh.k`: the deck is in no folder",
        ),
        ("*INCLUDE_PATH\nmesh\n", "line 1: `*INCLUDE…` is not read"),
        (
            "*PERTURBATION_NODE\n",
            "line 1: `*PERTURBATION_NODE` is not read",
        ),
        (
            "*PART_DUPLICATE\n",
            "line 1: `*PART_DUPLICATE…` is not read",
        ),
        (
            "*ELEMENT_SHELL_COMPOSITE\n",
            "`*ELEMENT_SHELL_COMPOSITE` is not",
        ),
        ("*ELEMENT_TSHELL\n", "line 1: `*ELEMENT_TSHELL` is not read"),
        ("*NODE +\n", "line 1: the long format"),
        (
            "*NODE\n&n,0,0,0\n",
            "line 2: no `*PARAMETER` before says what `&n` is",
        ),
        (
            "*PART_MOVE\n1,1,0,0,7\n",
            "line 2: a motion in a local system",
        ),
        (
            "*ELEMENT_SHELL_THICKNESS\n1,1,1,2,3,3\n*END\n",
            "line 3: cards of the element before are missing",
        ),
        (
            "*NODE\n1,0,0,0\n*ELEMENT_SPH\n1,1,2.0,1000000000\n",
            "1 to 1000000000, names nodes that are not there",
        ),
        (
            "*NODE\n1,0,0,0\n2,1,0,0\n*ELEMENT_SPH\n1,1,1.0,2\n1,1,1.0,2\n",
            "node 1 is in two ranges",
        ),
        ("*NODE\n1,0,0\n", "line 2: a node has a number and three"),
        ("*NODE\n1,0,0,nan\n", "line 2: `nan` is no number"),
        ("*NODE\n-1,0,0,0\n", "line 2: `-1` is no number of a node"),
        (
            "*NODE\n1 0.0 0.0 0.0\n",
            "line 2: `1 0.0 0.` is no number of a node",
        ),
        (
            "*ELEMENT_SOLID\n1,1\n*END\n",
            "line 3: cards of the element before are missing",
        ),
        (
            "*ELEMENT_SOLID\n1,1,1,2,3,4,5\n",
            "an element of 5 nodes is not read",
        ),
        ("*ELEMENT_SOLID_ORTHO\n", "only plain `*ELEMENT_SOLID`"),
        ("*ELEMENT_SPH\n1,1,x\n", "line 2: `x` is no number"),
    ] {
        let words = read(text).unwrap_err().words;
        assert!(words.contains(said), "{text:?}: {words}");
    }
}

const SQUARE: &str = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n";

#[test]
fn ranges_of_nodes_are_particles_of_one_card() {
    let text = format!("{SQUARE}*ELEMENT_SPH\n       2       7         -2.0e-3       4\n1,7,-1\n");
    let mesh = read(&text).unwrap();
    let points = mesh.points.iter().map(|point| (point.node, point.mass));
    let expected = [(1, -1.0), (2, -2e-3), (3, -2e-3), (4, -2e-3)];
    assert_eq!(points.collect::<Vec<_>>(), expected);
    assert_eq!(mesh.parts[0].points.len(), 4);
    let volumes = text.replace("SPH", "SPH_VOLUME").replace('-', "");
    assert_eq!(read(&volumes).unwrap().points[0].mass, -1.0);
}

#[test]
fn moved_parts_stand_where_they_are_moved_to() {
    let text = format!(
        "{SQUARE}*ELEMENT_SHELL_THICKNESS_OFFSET\n1,1,1,2,3,3\n.1,.1,.1\n.5\n\
         *PART_MOVE\n1,1,2,3\n1,0,0,4\n"
    );
    let mesh = read(&text).unwrap();
    assert_eq!(mesh.cells.len(), 1);
    assert_eq!(mesh.nodes[0].1, [1.0, 2.0, 7.0]);
    assert_eq!(mesh.nodes[3].1, [0.0, 1.0, 0.0]);
    let message = read(&format!("{text}*ELEMENT_SPH\n3,2,1\n"))
        .unwrap_err()
        .words;
    assert!(message.contains("node 3 is of two parts"), "{message}");
}

#[test]
fn shells_of_eight_nodes_have_two_cards_of_thickness() {
    let text =
        format!("{SQUARE}*ELEMENT_SHELL_THICKNESS\n1,1,1,2,3,4,5,6,7,8\n1\n1\n2,1,1,2,3,3\n1\n");
    assert_eq!(read(&text).unwrap().cells.len(), 2);
}

#[test]
fn integers_of_ten_columns_and_parameters_are_read() {
    let wide = "\x20        1             0.5              0.              0.\n";
    for text in [
        format!("*KEYWORD I10=Y\n*NODE\n{wide}"),
        format!("*KEYWORD\n*NODE %\n{wide}"),
        format!("*KEYWORD\n*NODE%\n{wide}"),
        "*PARAMETER\nRhalf           -0.5I  one            1\n*NODE\n&one,-&HALF,0,0\n".to_owned(),
    ] {
        assert_eq!(read(&text).unwrap().nodes, [(1, [0.5, 0.0, 0.0])], "{text}");
    }
}
