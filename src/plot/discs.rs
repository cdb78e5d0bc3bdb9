//! Discs that are drawn one after the other: circles while they are few, pixels once they are many.

use super::dots::{Disc, Dots};
use super::frame::Frame;

/// As many discs as are circles.
const FEW: usize = 10_000;

/// Discs cut at one frame.
#[derive(Debug)]
pub struct Discs {
    pub clip: Frame,
    /// The discs themselves, later ones over earlier ones, if they are few.
    pub few: Vec<Disc>,
    /// All of them, if they are many.
    pub many: Option<Dots>,
}

impl Default for Discs {
    fn default() -> Self {
        Self {
            clip: Frame::PAGE,
            few: Vec::new(),
            many: None,
        }
    }
}

impl Discs {
    /// Lays a disc over the others in a picture of a size, unless the frame shows nothing of it.
    pub fn add(&mut self, disc: Disc, size: (u32, u32)) {
        let (x, y) = disc.centre;
        let seen = self.clip.grown(disc.radius);
        let is_seen =
            (seen.left..=seen.right()).contains(&x) && (seen.top..=seen.bottom()).contains(&y);
        if !is_seen || disc.radius <= 0.0 {
            return;
        }
        if self.many.is_none() {
            self.few.push(disc);
            if self.few.len() > FEW {
                let mut dots = Dots::new(&self.clip, size);
                self.few.drain(..).for_each(|disc| dots.add(&disc));
                self.many = Some(dots);
            }
        } else if let Some(dots) = &mut self.many {
            dots.add(&disc);
        }
    }
}
