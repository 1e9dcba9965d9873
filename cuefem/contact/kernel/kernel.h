/* What the files of the contact's kernel share.

   Nothing here allocates, prints or keeps a state: Python hands over arrays (C order, double precision) and reads them.
   A result that cannot be had is a status; Python makes the message of it. The Python path is the oracle. */
#ifndef CUEFEM_KERNEL_H
#define CUEFEM_KERNEL_H

#include <math.h>
#include <stddef.h>

#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#else
#define EXPORTED __attribute__((visibility("default")))
#endif

/* A copy of a function for processors with AVX2, chosen when the library is loaded, where that is possible. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define FAST __attribute__((target_clones("arch=skylake-avx512", "avx2", "default")))
#else
#define FAST
#endif

/* Small loops that are to be compiled for the processor of the function that they stand in. */
#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#else
#define INLINE static inline
#endif

/* A function of one number. */
typedef double (*function)(const void *of, double x);

/* Where a function that is negative at `high` falls through zero after `low`, where it may be zero itself. */
double first_fall(function falling, const void *of, double low, double high);

/* The zero of a continuous function between two places of opposite sign, to 1e-15 and to rounding. */
double zero_of(function f, const void *of, double low, double high);

#endif
