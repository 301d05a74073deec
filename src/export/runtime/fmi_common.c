/* What both versions share: an instance and its variables by value reference.
 * References: inputs from 1, their slopes in 1/s where the hold is of first order, outputs,
 * parameters, in this order; 0 is time. */
#include "@NAME@.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NU @NU@
#define NS @NS@
#define NY @NY@
#define NP @NP@
#define RAMPS @RAMPS@
#define STEP @TS@

typedef struct {
    @NAME@_t model;
    double u[NU + 1];
    double slope[NU + 1];
    double y[NY + 1];
    double start_time;
    int dirty; /* parameters were changed */
} instance_t;

static void start(instance_t *f)
{
    if (f->dirty) {
        @NAME@_prepare(&f->model);
        f->dirty = 0;
    }
}

static int get_number(instance_t *f, unsigned reference, double *value)
{
    unsigned i = reference;
    if (i == 0) {
        *value = f->start_time + (double)f->model.sample * STEP;
        return 1;
    }
    i -= 1;
    if (i < NU) {
        *value = f->u[i];
        return 1;
    }
    i -= NU;
    if (i < NS) {
        *value = f->slope[i];
        return 1;
    }
    i -= NS;
    if (i < NY) {
        start(f);
        @NAME@_output(&f->model, f->u, f->y);
        *value = f->y[i];
        return 1;
    }
    i -= NY;
    if (i < NP) {
        *value = f->model.p[i];
        return 1;
    }
    return 0;
}

static int set_number(instance_t *f, unsigned reference, double value)
{
    unsigned i = reference;
    if (i == 0) {
        return 0;
    }
    i -= 1;
    if (i < NU) {
        f->u[i] = value;
        return 1;
    }
    i -= NU;
    if (i < NS) {
        f->slope[i] = value;
        return 1;
    }
    i -= NS;
    if (i < NY) {
        return 0;
    }
    i -= NY;
    if (i < NP) {
        f->model.p[i] = value;
        f->dirty = 1;
        return 1;
    }
    return 0;
}

/* Whole samples only: the integrator's step is part of the model. */
static int run(instance_t *f, double length)
{
    const double whole = floor(length / STEP + 0.5);
    long n = (long)whole, k;
    int i;
    double u[NU + 1], next[NU + 1];
    if (!(whole >= 1.0) || fabs(length - whole * STEP) > 1e-6 * STEP || whole > 1e9) {
        return 0;
    }
    start(f);
    for (k = 0; k < n; k++) {
        for (i = 0; i < NU; i++) {
            u[i] = f->u[i] + (RAMPS ? f->slope[i] * STEP * (double)k : 0.0);
            next[i] = u[i] + (RAMPS ? f->slope[i] * STEP : 0.0);
        }
        (void)next;
        @NAME@_step(&f->model, u, @NEXT@f->y);
    }
    return 1;
}

static instance_t *make(void)
{
    instance_t *f = (instance_t *)calloc(1, sizeof(instance_t));
    if (f != NULL) {
        @NAME@_init(&f->model);
    }
    return f;
}

static void begin_again(instance_t *f)
{
    memset(f, 0, sizeof(*f));
    @NAME@_init(&f->model);
}
