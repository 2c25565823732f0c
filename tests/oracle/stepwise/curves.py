"""Pressure over overclosure of the oracle's points: value and slope, written from the formulas alone."""


def line(stiffness, clearance=0.0):
    """`k (h + c0)` where that is positive."""

    def evaluate(h):
        x = h + clearance
        return (stiffness * x, stiffness) if x > 0.0 else (0.0, 0.0)

    return evaluate


def nonlinear(last, clearance, upper, ratio, lower):
    """Slope 0, Ki, linear to Kf, Kf; `upper` is e [length], `ratio` Ki / Kf, `lower` d / e."""
    first, start, width = ratio * last, lower * upper, upper - lower * upper

    def evaluate(h):
        x = h + clearance
        if x <= 0.0:
            return 0.0, 0.0
        if x <= start:
            return first * x, first
        if x <= upper:
            y = x - start
            return first * x + (last - first) * y * y / (2.0 * width), first + (last - first) * y / width
        return first * x + (last - first) * (0.5 * width + x - upper), last

    return evaluate


def dashpot(coefficient, clearance, fraction, start, duration):
    """Viscous pressure `mu(c) (h - h_start) / dt` and its slope; `mu` at the overclosure itself, which is that of the end."""

    def evaluate(h):
        open_, edge = -h, fraction * clearance
        if open_ >= clearance:
            return 0.0, 0.0
        speed = (h - start) / duration
        if open_ <= edge:
            return coefficient * speed, coefficient / duration
        slope = coefficient / (clearance - edge)
        mu = slope * (clearance - open_)
        return mu * speed, mu / duration + slope * speed

    return evaluate
