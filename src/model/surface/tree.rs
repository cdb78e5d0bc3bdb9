//! A tree of boxes around triangles, built once: the closest triangle in logarithmic time.

/// Triangles of a leaf.
const LEAF: usize = 4;
/// Deepest tree that is walked: more than 2³² triangles make.
const DEPTH: usize = 64;

#[derive(Debug, Clone, PartialEq)]
struct Node {
    lower: [f64; 3],
    upper: [f64; 3],
    /// First triangle of a leaf in `order`, or the second child (the first one is next).
    at: u32,
    /// Triangles of a leaf; zero for a branch.
    count: u32,
}

impl Node {
    fn distance2(&self, x: &[f64; 3]) -> f64 {
        let mut square = 0.0;
        for a in 0..3 {
            let beyond = (self.lower[a] - x[a]).max(x[a] - self.upper[a]).max(0.0);
            square += beyond * beyond;
        }
        square
    }
}

/// Boxes within boxes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Tree {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Tree {
    /// Bytes that it takes.
    pub fn memory(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.order[..])
    }

    /// A tree of boxes (m).
    pub fn new(boxes: &[([f64; 3], [f64; 3])]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            order: (0..u32::try_from(boxes.len()).unwrap_or(u32::MAX)).collect(),
        };
        if !boxes.is_empty() {
            tree.branch(boxes, 0, boxes.len());
        }
        tree
    }

    /// Makes the node of `order[start..end]`, halved along its longest side.
    fn branch(&mut self, boxes: &[([f64; 3], [f64; 3])], start: usize, end: usize) {
        let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for &t in &self.order[start..end] {
            let (low, high) = &boxes[t as usize];
            for a in 0..3 {
                lower[a] = lower[a].min(low[a]);
                upper[a] = upper[a].max(high[a]);
            }
        }
        let here = self.nodes.len();
        let leaf = end - start <= LEAF;
        self.nodes.push(Node {
            lower,
            upper,
            at: u32::try_from(start).unwrap_or(u32::MAX),
            count: if leaf {
                u32::try_from(end - start).unwrap_or(u32::MAX)
            } else {
                0
            },
        });
        if leaf {
            return;
        }
        let length = |a: usize| upper[a] - lower[a];
        let axis = (1..3).fold(0, |best, a| if length(a) > length(best) { a } else { best });
        let middle = |t: &u32| boxes[*t as usize].0[axis] + boxes[*t as usize].1[axis];
        self.order[start..end]
            .sort_unstable_by(|s, t| middle(s).total_cmp(&middle(t)).then(s.cmp(t)));
        let half = start + (end - start) / 2;
        self.branch(boxes, start, half);
        self.nodes[here].at = u32::try_from(self.nodes.len()).unwrap_or(u32::MAX);
        self.branch(boxes, half, end);
    }

    /// Calls `visit` with what may be nearer to `x` (m) than the square of a distance (m²), which
    /// begins at `limit2` and is what `visit` returned last.
    pub fn near(&self, x: &[f64; 3], limit2: f64, mut visit: impl FnMut(u32) -> f64) {
        let mut limit2 = limit2;
        let mut stack = [(0_u32, 0.0); DEPTH];
        let mut depth = 0;
        if let Some(root) = self.nodes.first() {
            stack[0] = (0, root.distance2(x));
            depth = 1;
        }
        while depth > 0 {
            depth -= 1;
            let (index, distance2) = stack[depth];
            if distance2 > limit2 {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count > 0 {
                let first = node.at as usize;
                for &t in &self.order[first..first + node.count as usize] {
                    limit2 = visit(t);
                }
                continue;
            }
            let mut children = [index + 1, node.at];
            let mut squares = children.map(|child| self.nodes[child as usize].distance2(x));
            if squares[0] < squares[1] {
                children.swap(0, 1);
                squares.swap(0, 1);
            }
            // The nearer one last: it comes off the stack first.
            for (child, square) in children.into_iter().zip(squares) {
                if square <= limit2 {
                    stack[depth] = (child, square);
                    depth += 1;
                }
            }
        }
    }

    /// Calls `visit` with all whose boxes meet the one between two corners (m).
    pub fn meeting(&self, lower: &[f64; 3], upper: &[f64; 3], mut visit: impl FnMut(u32)) {
        let mut open = vec![0_u32];
        while let Some(index) = open.pop() {
            let Some(node) = self.nodes.get(index as usize) else {
                break;
            };
            if (0..3).any(|a| node.lower[a] > upper[a] || node.upper[a] < lower[a]) {
                continue;
            }
            if node.count > 0 {
                let first = node.at as usize;
                for &t in &self.order[first..first + node.count as usize] {
                    visit(t);
                }
            } else {
                open.extend([node.at, index + 1]);
            }
        }
    }

    /// The largest `n·x` (m) of the items by their `support`, for a vector `n`.
    pub fn farthest(&self, n: &[f64; 3], support: impl Fn(u32) -> f64) -> f64 {
        let beyond = |node: &Node| {
            (0..3).fold(0.0, |sum, a| {
                sum + (n[a] * node.lower[a]).max(n[a] * node.upper[a])
            })
        };
        let mut farthest = f64::NEG_INFINITY;
        let mut stack = [0_u32; DEPTH];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if beyond(node) <= farthest {
                continue;
            }
            if node.count > 0 {
                let first = node.at as usize;
                let all = self.order[first..first + node.count as usize].iter();
                farthest = all.fold(farthest, |most, &t| most.max(support(t)));
                continue;
            }
            let mut children = [index + 1, node.at];
            if beyond(&self.nodes[children[0] as usize]) > beyond(&self.nodes[children[1] as usize])
            {
                children.swap(0, 1);
            }
            // The farther one last: it comes off the stack first.
            for child in children {
                stack[depth] = child;
                depth += 1;
            }
        }
        farthest
    }

    /// All in the order in which they are halved.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Box (m) around those from one place of the [order](Self::order) to before another, if these
    /// are a node.
    pub fn around(&self, first: usize, end: usize) -> Option<([f64; 3], [f64; 3])> {
        let (mut from, mut to, mut at) = (0, self.order.len(), 0);
        while let Some(node) = self.nodes.get(at) {
            if (from, to) == (first, end) {
                return Some((node.lower, node.upper));
            }
            if node.count > 0 {
                break;
            }
            let half = from + (to - from) / 2;
            (from, to, at) = if end <= half {
                (from, half, at + 1)
            } else {
                (half, to, node.at as usize)
            };
        }
        None
    }

    /// Smallest and largest coordinates of all (m).
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let root = self.nodes.first();
        root.map_or(([0.0; 3], [0.0; 3]), |root| (root.lower, root.upper))
    }
}
