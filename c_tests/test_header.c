/* The header alone, as C99 and as C11, with warnings as errors. */
#include "lapidary.h"

#include "lapidary.h"

int main(void)
{
    int32_t major = -1;
    return lap_version(&major, (int32_t *)0, (int32_t *)0, (const char **)0) == LAP_OK && major >= 0 ? 0 : 1;
}
