/* FMI 3.0 for co-simulation (Modelica Association, FMI 3.0.1): the declarations needed, no more. */
#include "fmi_common.h"

#include <stdbool.h>
#include <stdint.h>

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef void *fmi3Instance;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef const char *fmi3String;
typedef bool fmi3Boolean;
typedef double fmi3Float64;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;

#define DEFINED(name, arguments, status, ...)        \
    EXPORT fmi3Status name arguments;                \
    EXPORT fmi3Status name arguments                 \
    {                                                \
        __VA_ARGS__                                  \
        return status;                               \
    }
#define INSTANCE fmi3Instance c
#define REFERENCES const fmi3ValueReference r[], size_t n

EXPORT const char *fmi3GetVersion(void);
EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String, fmi3String, fmi3String, fmi3Boolean,
                                                fmi3Boolean, fmi3Boolean, fmi3Boolean,
                                                const fmi3ValueReference[], size_t, void *,
                                                const void *, const void *);
EXPORT fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token,
                                                fmi3String resources, fmi3Boolean visible,
                                                fmi3Boolean logging, fmi3Boolean events,
                                                fmi3Boolean early,
                                                const fmi3ValueReference required[], size_t n,
                                                void *environment, const void *log,
                                                const void *update)
{
    (void)name; (void)resources; (void)visible; (void)logging; (void)events; (void)early;
    (void)required; (void)n; (void)environment; (void)log; (void)update;
    if (token == NULL || strcmp(token, "@TOKEN@") != 0) {
        return NULL;
    }
    return make();
}

EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String, fmi3String, fmi3String, fmi3Boolean,
                                                 fmi3Boolean, void *, const void *);
EXPORT fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token,
                                                 fmi3String resources, fmi3Boolean visible,
                                                 fmi3Boolean logging, void *environment,
                                                 const void *log)
{
    (void)name; (void)token; (void)resources; (void)visible; (void)logging;
    (void)environment; (void)log;
    return NULL;
}

EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String, fmi3String, fmi3String,
                                                      fmi3Boolean, fmi3Boolean, void *,
                                                      const void *, const void *, const void *,
                                                      const void *);
EXPORT fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token,
                                                      fmi3String resources, fmi3Boolean visible,
                                                      fmi3Boolean logging, void *environment,
                                                      const void *log, const void *update,
                                                      const void *lock, const void *unlock)
{
    (void)name; (void)token; (void)resources; (void)visible; (void)logging;
    (void)environment; (void)log; (void)update; (void)lock; (void)unlock;
    return NULL;
}

EXPORT void fmi3FreeInstance(fmi3Instance);
EXPORT void fmi3FreeInstance(fmi3Instance c) { free(c); }

DEFINED(fmi3SetDebugLogging, (INSTANCE, fmi3Boolean on, size_t n, const fmi3String categories[]),
        fmi3OK, (void)c; (void)on; (void)n; (void)categories;)
DEFINED(fmi3EnterInitializationMode,
        (INSTANCE, fmi3Boolean has_tolerance, fmi3Float64 tolerance, fmi3Float64 start_time,
         fmi3Boolean has_stop, fmi3Float64 stop),
        fmi3OK, (void)has_tolerance; (void)tolerance; (void)has_stop; (void)stop;
        ((instance_t *)c)->start_time = start_time;)
DEFINED(fmi3ExitInitializationMode, (INSTANCE), fmi3OK, start((instance_t *)c);)
DEFINED(fmi3EnterEventMode, (INSTANCE), fmi3Error, (void)c;)
DEFINED(fmi3EnterStepMode, (INSTANCE), fmi3Error, (void)c;)
DEFINED(fmi3EnterConfigurationMode, (INSTANCE), fmi3Error, (void)c;)
DEFINED(fmi3ExitConfigurationMode, (INSTANCE), fmi3Error, (void)c;)
DEFINED(fmi3Terminate, (INSTANCE), fmi3OK, (void)c;)
DEFINED(fmi3Reset, (INSTANCE), fmi3OK, begin_again((instance_t *)c);)

EXPORT fmi3Status fmi3GetFloat64(INSTANCE, REFERENCES, fmi3Float64 values[], size_t nv);
EXPORT fmi3Status fmi3GetFloat64(INSTANCE, REFERENCES, fmi3Float64 values[], size_t nv)
{
    size_t i;
    if (n != nv) {
        return fmi3Error;
    }
    for (i = 0; i < n; i++) {
        if (!get_number((instance_t *)c, r[i], &values[i])) {
            return fmi3Error;
        }
    }
    return fmi3OK;
}

EXPORT fmi3Status fmi3SetFloat64(INSTANCE, REFERENCES, const fmi3Float64 values[], size_t nv);
EXPORT fmi3Status fmi3SetFloat64(INSTANCE, REFERENCES, const fmi3Float64 values[], size_t nv)
{
    size_t i;
    if (n != nv) {
        return fmi3Error;
    }
    for (i = 0; i < n; i++) {
        if (!set_number((instance_t *)c, r[i], values[i])) {
            return fmi3Error;
        }
    }
    return fmi3OK;
}

#define OTHER_TYPE(name, type)                                                                    \
    DEFINED(fmi3Get##name, (INSTANCE, REFERENCES, type values[], size_t nv),                      \
            n == 0 ? fmi3OK : fmi3Error, (void)c; (void)r; (void)values; (void)nv;)               \
    DEFINED(fmi3Set##name, (INSTANCE, REFERENCES, const type values[], size_t nv),                \
            n == 0 ? fmi3OK : fmi3Error, (void)c; (void)r; (void)values; (void)nv;)
OTHER_TYPE(Float32, float)
OTHER_TYPE(Int8, int8_t)
OTHER_TYPE(UInt8, uint8_t)
OTHER_TYPE(Int16, int16_t)
OTHER_TYPE(UInt16, uint16_t)
OTHER_TYPE(Int32, int32_t)
OTHER_TYPE(UInt32, uint32_t)
OTHER_TYPE(Int64, int64_t)
OTHER_TYPE(UInt64, uint64_t)
OTHER_TYPE(Boolean, fmi3Boolean)
OTHER_TYPE(String, fmi3String)

DEFINED(fmi3GetBinary, (INSTANCE, REFERENCES, size_t sizes[], fmi3Binary values[], size_t nv),
        n == 0 ? fmi3OK : fmi3Error, (void)c; (void)r; (void)sizes; (void)values; (void)nv;)
DEFINED(fmi3SetBinary,
        (INSTANCE, REFERENCES, const size_t sizes[], const fmi3Binary values[], size_t nv),
        n == 0 ? fmi3OK : fmi3Error, (void)c; (void)r; (void)sizes; (void)values; (void)nv;)
DEFINED(fmi3GetClock, (INSTANCE, REFERENCES, fmi3Clock values[]), n == 0 ? fmi3OK : fmi3Error,
        (void)c; (void)r; (void)values;)
DEFINED(fmi3SetClock, (INSTANCE, REFERENCES, const fmi3Clock values[]),
        n == 0 ? fmi3OK : fmi3Error, (void)c; (void)r; (void)values;)

/* values after the arguments (point, length, nothing to set back) */
EXPORT fmi3Status fmi3DoStep(INSTANCE, fmi3Float64, fmi3Float64, fmi3Boolean, fmi3Boolean *,
                             fmi3Boolean *, fmi3Boolean *, fmi3Float64 *);
EXPORT fmi3Status fmi3DoStep(INSTANCE, fmi3Float64 point, fmi3Float64 length, fmi3Boolean keep,
                             fmi3Boolean *event, fmi3Boolean *ended, fmi3Boolean *early,
                             fmi3Float64 *last)
{
    (void)keep;
    if (!run((instance_t *)c, length)) {
        return fmi3Error;
    }
    *event = false;
    *ended = false;
    *early = false;
    *last = point + length;
    return fmi3OK;
}

DEFINED(fmi3GetNumberOfVariableDependencies, (INSTANCE, fmi3ValueReference r, size_t *n), fmi3Error,
        (void)c; (void)r; (void)n;)
DEFINED(fmi3GetVariableDependencies,
        (INSTANCE, fmi3ValueReference d, size_t di[], fmi3ValueReference i[], size_t ii[],
         int kinds[], size_t n),
        fmi3Error, (void)c; (void)d; (void)di; (void)i; (void)ii; (void)kinds; (void)n;)
DEFINED(fmi3GetFMUState, (INSTANCE, fmi3FMUState *s), fmi3Error, (void)c; (void)s;)
DEFINED(fmi3SetFMUState, (INSTANCE, fmi3FMUState s), fmi3Error, (void)c; (void)s;)
DEFINED(fmi3FreeFMUState, (INSTANCE, fmi3FMUState *s), fmi3Error, (void)c; (void)s;)
DEFINED(fmi3SerializedFMUStateSize, (INSTANCE, fmi3FMUState s, size_t *n), fmi3Error,
        (void)c; (void)s; (void)n;)
DEFINED(fmi3SerializeFMUState, (INSTANCE, fmi3FMUState s, fmi3Byte b[], size_t n), fmi3Error,
        (void)c; (void)s; (void)b; (void)n;)
DEFINED(fmi3DeserializeFMUState, (INSTANCE, const fmi3Byte b[], size_t n, fmi3FMUState *s),
        fmi3Error, (void)c; (void)b; (void)n; (void)s;)
DEFINED(fmi3GetDirectionalDerivative,
        (INSTANCE, const fmi3ValueReference z[], size_t nz, const fmi3ValueReference k[],
         size_t nk, const fmi3Float64 seed[], size_t ns, fmi3Float64 out[], size_t no),
        fmi3Error, (void)c; (void)z; (void)nz; (void)k; (void)nk; (void)seed; (void)ns; (void)out;
        (void)no;)
DEFINED(fmi3GetAdjointDerivative,
        (INSTANCE, const fmi3ValueReference z[], size_t nz, const fmi3ValueReference k[],
         size_t nk, const fmi3Float64 seed[], size_t ns, fmi3Float64 out[], size_t no),
        fmi3Error, (void)c; (void)z; (void)nz; (void)k; (void)nk; (void)seed; (void)ns; (void)out;
        (void)no;)
DEFINED(fmi3GetIntervalDecimal, (INSTANCE, REFERENCES, fmi3Float64 i[], int q[]), fmi3Error,
        (void)c; (void)r; (void)n; (void)i; (void)q;)
DEFINED(fmi3GetIntervalFraction,
        (INSTANCE, REFERENCES, uint64_t i[], uint64_t z[], int q[]), fmi3Error,
        (void)c; (void)r; (void)n; (void)i; (void)z; (void)q;)
DEFINED(fmi3GetShiftDecimal, (INSTANCE, REFERENCES, fmi3Float64 s[]), fmi3Error,
        (void)c; (void)r; (void)n; (void)s;)
DEFINED(fmi3GetShiftFraction, (INSTANCE, REFERENCES, uint64_t s[], uint64_t z[]), fmi3Error,
        (void)c; (void)r; (void)n; (void)s; (void)z;)
DEFINED(fmi3SetIntervalDecimal, (INSTANCE, REFERENCES, const fmi3Float64 i[]), fmi3Error,
        (void)c; (void)r; (void)n; (void)i;)
DEFINED(fmi3SetIntervalFraction, (INSTANCE, REFERENCES, const uint64_t i[], const uint64_t z[]),
        fmi3Error, (void)c; (void)r; (void)n; (void)i; (void)z;)
DEFINED(fmi3SetShiftDecimal, (INSTANCE, REFERENCES, const fmi3Float64 s[]), fmi3Error,
        (void)c; (void)r; (void)n; (void)s;)
DEFINED(fmi3SetShiftFraction, (INSTANCE, REFERENCES, const uint64_t s[], const uint64_t z[]),
        fmi3Error, (void)c; (void)r; (void)n; (void)s; (void)z;)
DEFINED(fmi3EvaluateDiscreteStates, (INSTANCE), fmi3Error, (void)c;)
DEFINED(fmi3UpdateDiscreteStates,
        (INSTANCE, fmi3Boolean *a, fmi3Boolean *b, fmi3Boolean *d, fmi3Boolean *e, fmi3Boolean *f,
         fmi3Float64 *t),
        fmi3Error, (void)c; (void)a; (void)b; (void)d; (void)e; (void)f; (void)t;)
DEFINED(fmi3EnterContinuousTimeMode, (INSTANCE), fmi3Error, (void)c;)
DEFINED(fmi3CompletedIntegratorStep,
        (INSTANCE, fmi3Boolean keep, fmi3Boolean *event, fmi3Boolean *end), fmi3Error,
        (void)c; (void)keep; (void)event; (void)end;)
DEFINED(fmi3SetTime, (INSTANCE, fmi3Float64 t), fmi3Error, (void)c; (void)t;)
DEFINED(fmi3SetContinuousStates, (INSTANCE, const fmi3Float64 x[], size_t n), fmi3Error,
        (void)c; (void)x; (void)n;)
DEFINED(fmi3GetContinuousStateDerivatives, (INSTANCE, fmi3Float64 x[], size_t n), fmi3Error,
        (void)c; (void)x; (void)n;)
DEFINED(fmi3GetEventIndicators, (INSTANCE, fmi3Float64 x[], size_t n), fmi3Error,
        (void)c; (void)x; (void)n;)
DEFINED(fmi3GetContinuousStates, (INSTANCE, fmi3Float64 x[], size_t n), fmi3Error,
        (void)c; (void)x; (void)n;)
DEFINED(fmi3GetNominalsOfContinuousStates, (INSTANCE, fmi3Float64 x[], size_t n), fmi3Error,
        (void)c; (void)x; (void)n;)
DEFINED(fmi3GetNumberOfEventIndicators, (INSTANCE, size_t *n), fmi3Error, (void)c; (void)n;)
DEFINED(fmi3GetNumberOfContinuousStates, (INSTANCE, size_t *n), fmi3Error, (void)c; (void)n;)
DEFINED(fmi3GetOutputDerivatives,
        (INSTANCE, REFERENCES, const int32_t orders[], fmi3Float64 values[], size_t nv), fmi3Error,
        (void)c; (void)r; (void)n; (void)orders; (void)values; (void)nv;)
DEFINED(fmi3ActivateModelPartition, (INSTANCE, fmi3ValueReference r, fmi3Float64 t), fmi3Error,
        (void)c; (void)r; (void)t;)
