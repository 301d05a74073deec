//! A PID controller at samples, with a filtered derivative, limits and anti-windup.

use lacuna::prelude::*;

/// One output that is led along a reference (Astrom and Hagglund, *Advanced PID Control*, 2006,
/// ch. 3 and 13), e = r - y, h the sampling time:
///
/// ```text
/// v = kp e + I - kd (y - m) / (Tf + h),    u = min(max(v, min), max)
/// m+ = m + h (y - m) / (Tf + h)            the output, filtered: its difference is the rate
/// I+ = I + h ki e + h (u - v) / Tt         back-calculation: I stops where u is at a limit
/// ```
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pid {
    /// s.
    pub sampling_time: f64,
    /// Unit of the command over that of the output.
    pub kp: f64,
    /// The same per s.
    #[serde(default)]
    pub ki: f64,
    /// The same times s.
    #[serde(default)]
    pub kd: f64,
    /// Time constant Tf of the derivative, s.
    #[serde(default)]
    pub filter: f64,
    /// Smallest command; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Largest command; none where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Time constant Tt of the anti-windup, s; absent: kp / ki.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tracking: Option<f64>,
}

impl Pid {
    /// The command before and after its limits.
    #[inline(always)]
    fn command<R: Real>(&self, at: &At<R>) -> [R; 2] {
        let &[kp, _, kd] = at.parameters();
        let &[integral, filtered] = at.states();
        let &[reference, measured] = at.inputs();
        let over = 1.0 / (self.filter + self.sampling_time);
        let v = kp * (reference - measured) + integral - kd * (measured - filtered) * over;
        let low = R::constant(self.min.unwrap_or(f64::NEG_INFINITY));
        let high = R::constant(self.max.unwrap_or(f64::INFINITY));
        [v, v.max(low).min(high)]
    }
}

impl Physics for Pid {
    fn signals(&self) -> Signals {
        Signals::discrete()
            .input("reference", "")
            .input("measured", "")
            .state("integral", "", 0.0)
            .state("filtered", "", 0.0)
            .output("command", "")
            .parameter("kp", self.kp, "")
            .parameter("ki", self.ki, "1/s")
            .parameter("kd", self.kd, "s")
    }

    fn faults(&self) -> Vec<Fault> {
        let mut faults = Fault::unless_positive(&[("sampling_time", self.sampling_time)]);
        if !(self.filter >= 0.0 && self.filter.is_finite()) {
            faults.push(Fault::new("filter", self.filter, "a number of at least 0"));
        }
        if let Some(tracking) = self.tracking {
            faults.extend(Fault::unless_positive(&[("tracking", tracking)]));
        }
        if let (Some(min), Some(max)) = (self.min, self.max)
            && !(min < max)
        {
            faults.push(Fault::new("min", min, format!("less than `max`, {max}")));
        }
        faults
    }

    #[inline(always)]
    fn derivative<R: Real>(&self, at: &At<R>, next: &mut [R]) {
        let &[_, ki, _] = at.parameters();
        let &[integral, filtered] = at.states();
        let &[reference, measured] = at.inputs();
        let h = self.sampling_time;
        let [v, u] = self.command(at);
        let own = if self.ki != 0.0 { (self.kp / self.ki).abs() } else { f64::INFINITY };
        let tracking = self.tracking.unwrap_or(own);
        let back = if tracking > 0.0 { h / tracking } else { 1.0 };
        next[0] = integral + ki * (reference - measured) * h + (u - v) * back.min(1.0);
        next[1] = filtered + (measured - filtered) * (h / (self.filter + h));
    }

    #[inline(always)]
    fn output<R: Real>(&self, at: &At<R>, y: &mut [R]) {
        y[0] = self.command(at)[1];
    }
}

lacuna::register!(StateSpaceModel for Pid, "pid", "a PID controller with limits and anti-windup, at samples",
    "sampling_time = 0.05\nkp = 4.0\nki = 2.0\nkd = 0.3\nfilter = 0.02");
