/* FMI 2.0 for co-simulation (Modelica Association, FMI 2.0.4): the declarations needed, no more. */
#include "fmi_common.h"

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef void *fmi2Component;
typedef void *fmi2FMUstate;
typedef unsigned fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char *fmi2String;
typedef char fmi2Byte;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;

#define NOT_OFFERED(name, arguments, ...)            \
    EXPORT fmi2Status name arguments;                \
    EXPORT fmi2Status name arguments                 \
    {                                                \
        __VA_ARGS__                                  \
        return fmi2Error;                            \
    }
#define NOTHING_TO_DO(name, arguments, ...)          \
    EXPORT fmi2Status name arguments;                \
    EXPORT fmi2Status name arguments                 \
    {                                                \
        __VA_ARGS__                                  \
        return fmi2OK;                               \
    }

EXPORT const char *fmi2GetTypesPlatform(void);
EXPORT const char *fmi2GetTypesPlatform(void) { return "default"; }
EXPORT const char *fmi2GetVersion(void);
EXPORT const char *fmi2GetVersion(void) { return "2.0"; }

EXPORT fmi2Component fmi2Instantiate(fmi2String, int, fmi2String, fmi2String, const void *,
                                     fmi2Boolean, fmi2Boolean);
EXPORT fmi2Component fmi2Instantiate(fmi2String name, int type, fmi2String guid,
                                     fmi2String resources, const void *functions,
                                     fmi2Boolean visible, fmi2Boolean logging)
{
    (void)name; (void)resources; (void)functions; (void)visible; (void)logging;
    /* 1 is co-simulation */
    if (type != 1 || guid == NULL || strcmp(guid, "@TOKEN@") != 0) {
        return NULL;
    }
    return make();
}

EXPORT void fmi2FreeInstance(fmi2Component);
EXPORT void fmi2FreeInstance(fmi2Component c) { free(c); }

EXPORT fmi2Status fmi2SetupExperiment(fmi2Component, fmi2Boolean, fmi2Real, fmi2Real, fmi2Boolean,
                                      fmi2Real);
EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance,
                                      fmi2Real tolerance, fmi2Real start_time,
                                      fmi2Boolean has_stop, fmi2Real stop)
{
    (void)has_tolerance; (void)tolerance; (void)has_stop; (void)stop;
    ((instance_t *)c)->start_time = start_time;
    return fmi2OK;
}

EXPORT fmi2Status fmi2Reset(fmi2Component);
EXPORT fmi2Status fmi2Reset(fmi2Component c)
{
    begin_again((instance_t *)c);
    return fmi2OK;
}

NOTHING_TO_DO(fmi2SetDebugLogging,
              (fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]),
              (void)c; (void)on; (void)n; (void)categories;)
NOTHING_TO_DO(fmi2EnterInitializationMode, (fmi2Component c), (void)c;)
NOTHING_TO_DO(fmi2ExitInitializationMode, (fmi2Component c), start((instance_t *)c);)
NOTHING_TO_DO(fmi2Terminate, (fmi2Component c), (void)c;)

EXPORT fmi2Status fmi2GetReal(fmi2Component, const fmi2ValueReference[], size_t, fmi2Real[]);
EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference references[], size_t n,
                              fmi2Real values[])
{
    size_t i;
    for (i = 0; i < n; i++) {
        if (!get_number((instance_t *)c, references[i], &values[i])) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2SetReal(fmi2Component, const fmi2ValueReference[], size_t, const fmi2Real[]);
EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference references[], size_t n,
                              const fmi2Real values[])
{
    size_t i;
    for (i = 0; i < n; i++) {
        if (!set_number((instance_t *)c, references[i], values[i])) {
            return fmi2Error;
        }
    }
    return fmi2OK;
}

#define OTHER_TYPE(name, type)                                                                  \
    EXPORT fmi2Status fmi2Get##name(fmi2Component, const fmi2ValueReference[], size_t, type[]);  \
    EXPORT fmi2Status fmi2Get##name(fmi2Component c, const fmi2ValueReference r[], size_t n,    \
                                    type values[])                                              \
    {                                                                                           \
        (void)c; (void)r; (void)values;                                                         \
        return n == 0 ? fmi2OK : fmi2Error;                                                     \
    }                                                                                           \
    EXPORT fmi2Status fmi2Set##name(fmi2Component, const fmi2ValueReference[], size_t,          \
                                    const type[]);                                              \
    EXPORT fmi2Status fmi2Set##name(fmi2Component c, const fmi2ValueReference r[], size_t n,    \
                                    const type values[])                                        \
    {                                                                                           \
        (void)c; (void)r; (void)values;                                                         \
        return n == 0 ? fmi2OK : fmi2Error;                                                     \
    }
OTHER_TYPE(Integer, fmi2Integer)
OTHER_TYPE(Boolean, fmi2Boolean)
OTHER_TYPE(String, fmi2String)

/* The slope of an input between samples, where the model's hold is of first order. */
EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component, const fmi2ValueReference[], size_t,
                                              const fmi2Integer[], const fmi2Real[]);
EXPORT fmi2Status fmi2SetRealInputDerivatives(fmi2Component c,
                                              const fmi2ValueReference references[], size_t n,
                                              const fmi2Integer order[], const fmi2Real values[])
{
    size_t i;
    for (i = 0; i < n; i++) {
        if (!RAMPS || order[i] != 1 || references[i] < 1 || references[i] > NU) {
            return fmi2Error;
        }
        ((instance_t *)c)->slope[references[i] - 1] = values[i];
    }
    return fmi2OK;
}

EXPORT fmi2Status fmi2DoStep(fmi2Component, fmi2Real, fmi2Real, fmi2Boolean);
EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real point, fmi2Real length, fmi2Boolean keep)
{
    (void)point; (void)keep;
    return run((instance_t *)c, length) ? fmi2OK : fmi2Error;
}

NOT_OFFERED(fmi2GetFMUstate, (fmi2Component c, fmi2FMUstate *s), (void)c; (void)s;)
NOT_OFFERED(fmi2SetFMUstate, (fmi2Component c, fmi2FMUstate s), (void)c; (void)s;)
NOT_OFFERED(fmi2FreeFMUstate, (fmi2Component c, fmi2FMUstate *s), (void)c; (void)s;)
NOT_OFFERED(fmi2SerializedFMUstateSize, (fmi2Component c, fmi2FMUstate s, size_t *n),
            (void)c; (void)s; (void)n;)
NOT_OFFERED(fmi2SerializeFMUstate, (fmi2Component c, fmi2FMUstate s, fmi2Byte b[], size_t n),
            (void)c; (void)s; (void)b; (void)n;)
NOT_OFFERED(fmi2DeSerializeFMUstate,
            (fmi2Component c, const fmi2Byte b[], size_t n, fmi2FMUstate *s),
            (void)c; (void)b; (void)n; (void)s;)
NOT_OFFERED(fmi2GetDirectionalDerivative,
            (fmi2Component c, const fmi2ValueReference z[], size_t nz,
             const fmi2ValueReference v[], size_t nv, const fmi2Real dv[], fmi2Real dz[]),
            (void)c; (void)z; (void)nz; (void)v; (void)nv; (void)dv; (void)dz;)
NOT_OFFERED(fmi2GetRealOutputDerivatives,
            (fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer order[],
             fmi2Real values[]),
            (void)c; (void)r; (void)n; (void)order; (void)values;)
NOT_OFFERED(fmi2CancelStep, (fmi2Component c), (void)c;)
NOT_OFFERED(fmi2GetStatus, (fmi2Component c, int kind, fmi2Status *value),
            (void)c; (void)kind; (void)value;)
NOT_OFFERED(fmi2GetRealStatus, (fmi2Component c, int kind, fmi2Real *value),
            (void)c; (void)kind; (void)value;)
NOT_OFFERED(fmi2GetIntegerStatus, (fmi2Component c, int kind, fmi2Integer *value),
            (void)c; (void)kind; (void)value;)
NOT_OFFERED(fmi2GetBooleanStatus, (fmi2Component c, int kind, fmi2Boolean *value),
            (void)c; (void)kind; (void)value;)
NOT_OFFERED(fmi2GetStringStatus, (fmi2Component c, int kind, fmi2String *value),
            (void)c; (void)kind; (void)value;)
