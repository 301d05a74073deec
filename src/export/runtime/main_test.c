/* Written by `lacuna export`: compares with the test vector: to 1e-9 of each output's largest value. */
#include "model.h"
#include "test_vector.h"

#include <math.h>
#include <stdio.h>

int main(void)
{
    static model_t m;
    double y[MODEL_OUTPUTS + 1];
    double worst = 0.0;
    double largest[MODEL_OUTPUTS + 1] = {0.0};
    double off[MODEL_OUTPUTS + 1] = {0.0};
    int k, i;
    model_init(&m);
    for (k = 0; k < TEST_SAMPLES; k++) {
        model_step(&m, test_u[k], U_NEXTy);
        for (i = 0; i < MODEL_OUTPUTS; i++) {
            const double difference = fabs(y[i] - test_y[k][i]);
            if (fabs(test_y[k][i]) > largest[i]) {
                largest[i] = fabs(test_y[k][i]);
            }
            if (!(difference <= off[i])) {
                off[i] = difference;
            }
        }
    }
    for (i = 0; i < MODEL_OUTPUTS; i++) {
        const double share = off[i] / (largest[i] > 0.0 ? largest[i] : 1.0);
        if (!(share <= worst)) {
            worst = share;
        }
    }
    printf("largest difference from the simulation: %.3g of the largest value\n", worst);
    return worst <= 1e-9 ? 0 : 1;
}
