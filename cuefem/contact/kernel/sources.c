/* Which sources the kernel was built from, so that an older binary is not taken for a newer one. */
#include "kernel.h"

#ifndef CUEFEM_SOURCES
#define CUEFEM_SOURCES ""
#endif

EXPORTED const char *cuefem_sources(void)
{
    return CUEFEM_SOURCES;
}
