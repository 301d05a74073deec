/* Mean over the step of what entered `back` steps ago and was held. */
static double past_held(const MODEL_T *m, int line, double back, double now)
{
    const double whole = floor(back);
    const double part = back - whole;
    const double newer = past(m, line, whole, now);
    const double older = past(m, line, whole + 1.0, now);
    return part == 0.0 ? newer : (1.0 - part) * newer + part * older;
}

