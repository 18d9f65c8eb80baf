// Sums of many numbers in binary32, and their spread. Pure functions.
#ifndef Q3RT_LIB_SUMS_GLSL
#define Q3RT_LIB_SUMS_GLSL
#include "shared/types.h"

// Compensated summation (Kahan 1965, "Further Remarks on Reducing Truncation Errors"): `low` is what rounding has added
// to the sum too much. Of n terms the sum's error stays below 2 u |sum| + O(n u^2) sum |x|, u the unit roundoff: beyond
// a million terms nothing is lost. `precise`: the three differences must not be simplified away.
void addCompensated(INOUT(vec3) sum, INOUT(vec3) low, vec3 value)
{
    precise vec3 added = value - low;
    precise vec3 total = sum + added;
    precise vec3 taken = total - sum;
    precise vec3 excess = taken - added;
    low = excess;
    sum = total;
}

// Mean and sum of squared distances from it of n values, the n-th being added (Welford 1962, "Note on a Method for
// Calculating Corrected Sums of Squares and Products").
void addToSpread(INOUT(float) mean, INOUT(float) squares, float value, float n)
{
    float apart = value - mean;
    mean += apart / n;
    squares += apart * (value - mean);
}

#endif
