//! Where the model is cut open.

use glam::DVec3;
use solidray::Solid;

use super::super::numbers;

/// A plane that cuts something away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cut {
    /// Across an axis; what is on the viewer's side goes.
    Across { axis: usize, at: f64 },
    /// What is left has `normal · p ≤ offset`.
    Plane { normal: DVec3, offset: f64 },
}

impl Cut {
    /// `x=1`, `y=2`, `z=3`, or the four numbers of a plane.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "`{text}` is neither like z=3 nor four numbers A,B,C,D that leave what has Ax + By + Cz ≤ D"
            )
        };
        if let Some((name, at)) = text.split_once('=') {
            let axis = ["x", "y", "z"].iter().position(|axis| *axis == name.trim());
            let at = at.trim().parse::<f64>().ok().filter(|at| at.is_finite());
            let (Some(axis), Some(at)) = (axis, at) else { return Err(wrong()) };
            return Ok(Self::Across { axis, at });
        }
        match numbers::list(text).map_err(|_| wrong())?[..] {
            [a, b, c, d] if [a, b, c, d].iter().all(|x| x.is_finite()) => {
                let normal = DVec3::new(a, b, c);
                if normal == DVec3::ZERO {
                    return Err(format!(
                        "`{text}`: a plane's first three numbers are not all zero"
                    ));
                }
                Ok(Self::Plane { normal, offset: d })
            }
            _ => Err(wrong()),
        }
    }

    /// What is left of a solid that is looked at in a direction.
    pub(super) fn applied(self, solid: &Solid, forward: DVec3) -> Solid {
        match self {
            Self::Across { axis, at } => {
                let side = if forward[axis] <= 0.0 { 1.0 } else { -1.0 };
                solid.section(side * DVec3::AXES[axis], side * at)
            }
            Self::Plane { normal, offset } => solid.section(normal, offset),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_are_read() {
        assert_eq!(Cut::parse("z=3"), Ok(Cut::Across { axis: 2, at: 3.0 }));
        assert_eq!(Cut::parse(" x = -1e3"), Ok(Cut::Across { axis: 0, at: -1000.0 }));
        let plane = Cut::Plane { normal: DVec3::new(1.0, -2.0, 0.0), offset: 4.5 };
        assert_eq!(Cut::parse("1,-2,0,4.5"), Ok(plane));
        for wrong in
            ["", "z", "z=", "w=1", "z=inf", "1,2,3", "1,2,3,nan", "0,0,0,1", "a,b,c,d"]
        {
            assert!(Cut::parse(wrong).is_err(), "{wrong}");
        }
    }
}
