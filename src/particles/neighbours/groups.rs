//! Groups of bodies that see each other in the SPH sums.

use model::{Case, ContactMode, SphForm};

/// The groups of a case: bodies that `kernel` contact joins form one, all others one each. Those of
/// their stress points, if any, come after them in the same order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Groups {
    /// Group of each body.
    pub of_body: Vec<usize>,
    /// True if a group is a rigid body.
    pub rigid: Vec<bool>,
    /// Number of groups that the bodies form.
    pub of_bodies: usize,
}

impl Groups {
    /// Of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        let of_body = join(case);
        let of_bodies = of_body.iter().max().map_or(0, |&g| g + 1);
        let count = match case.sph.form {
            SphForm::StressPoints => 2 * of_bodies,
            _ => of_bodies,
        };
        let mut rigid = vec![false; count];
        for (body, &group) in case.bodies.iter().zip(&of_body) {
            rigid[group] |= body.rigid.is_some();
        }
        Self {
            of_body,
            rigid,
            of_bodies,
        }
    }

    /// Number of groups, those of stress points included.
    #[must_use]
    pub fn count(&self) -> usize {
        self.rigid.len()
    }

    /// The bodies of a group.
    pub fn members(&self, group: usize) -> impl Iterator<Item = usize> + Clone + '_ {
        let group = group % self.of_bodies;
        (0..self.of_body.len()).filter(move |&body| self.of_body[body] == group)
    }
}

/// Numbers the groups of bodies that `kernel` contact joins, in the order of their first body.
/// Members of one group see each other in the SPH sums and nowhere else.
fn join(case: &Case) -> Vec<usize> {
    let n = case.bodies.len();
    let mut leader: Vec<usize> = (0..n).collect();
    let joins = |mode: &ContactMode| matches!(mode, ContactMode::Kernel);
    let named = case.contacts.iter().map(|pair| &pair.mode);
    if !named.chain([&case.default_contact]).any(joins) {
        return leader;
    }
    for a in 0..n {
        for b in a + 1..n {
            if joins(case.contact_between(a, b)) {
                let (keep, drop) = (leader[a].min(leader[b]), leader[a].max(leader[b]));
                for entry in &mut leader {
                    if *entry == drop {
                        *entry = keep;
                    }
                }
            }
        }
    }
    let mut leaders: Vec<usize> = leader.clone();
    leaders.sort_unstable();
    leaders.dedup();
    leader
        .iter()
        .map(|l| leaders.iter().position(|x| x == l).expect("its own leader"))
        .collect()
}
