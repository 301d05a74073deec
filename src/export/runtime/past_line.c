/* Value on the straight lines between what entered, `at` steps from now. */
static double past_line(const MODEL_T *m, int line, double at, double now, double end)
{
    double whole, newer, older;
    if (at >= 0.0) {
        return now + at * (end - now);
    }
    whole = floor(-at);
    newer = past(m, line, whole, now);
    older = past(m, line, whole + 1.0, now);
    return newer + (-at - whole) * (older - newer);
}

