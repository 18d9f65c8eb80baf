// Points that fill the unit square evenly whatever their number, for each dimension of the integrand anew: the first
// two dimensions of Sobol's sequence (1967), Owen-scrambled (Owen 1995), so that each point by itself is uniform over
// the scrambles: expected values are exact. Scrambling by a hash: Laine and Karras 2011, "Stratified Sampling for
// Stochastic Transparency"; shuffled indices pair dimensions: Burley 2020, "Practical Hash-based Owen Scrambling" (JCGT
// 9, 4).
#ifndef Q3RT_LIB_LOW_DISCREPANCY_GLSL
#define Q3RT_LIB_LOW_DISCREPANCY_GLSL

// A permutation of 32-bit numbers in which a bit only depends on itself and the bits below it.
uint scrambleUpward(uint x, uint seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

// Binomial coefficients modulo 2 applied to the bits of an index: bit i is the sum of the bits j whose number holds all
// ones of i's. Mirrored, this is the sequence's second dimension; the index itself is the first.
uint pascalBits(uint x)
{
    x ^= (x & 0xaaaaaaaau) >> 1u;
    x ^= (x & 0xccccccccu) >> 2u;
    x ^= (x & 0xf0f0f0f0u) >> 4u;
    x ^= (x & 0xff00ff00u) >> 8u;
    x ^= x >> 16u;
    return x;
}

// Point `index` of the sequence that belongs to the seeds, 32 bits a component. Different first seeds put the points of
// one set in another order, so that several pairs of dimensions together fill their cube.
uvec2 lowDiscrepancyPoint(uint index, uvec3 seeds)
{
    uint shuffled = bitfieldReverse(scrambleUpward(bitfieldReverse(index), seeds.x));
    return uvec2(bitfieldReverse(scrambleUpward(shuffled, seeds.y)),
                 bitfieldReverse(scrambleUpward(pascalBits(shuffled), seeds.z)));
}

#endif
