static const long depths[] = {DEPTHS};
static const long firsts[] = {FIRSTS};

/* What entered a delay line some whole steps ago, the oldest value before the start. */
static double past(const MODEL_T *m, int line, double steps, double now)
{
    const long depth = depths[line];
    long known = m->filled[line] + 1 < depth ? m->filled[line] : depth - 1;
    long back, at;
    if (!(steps > 0.0)) {
        return now;
    }
    back = steps < (double)known ? (long)steps : known;
    if (back == 0) {
        return now;
    }
    at = (m->head[line] + depth - (back - 1)) % depth;
    return m->past[firsts[line] + at];
}

static void enter(MODEL_T *m, int line, double now)
{
    const long depth = depths[line];
    m->head[line] = (m->head[line] + 1) % depth;
    m->past[firsts[line] + m->head[line]] = now;
    if (m->filled[line] < depth) {
        m->filled[line] += 1;
    }
}

