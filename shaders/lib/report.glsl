// How far a mean of samples is from the truth, from its own spread. Pure functions.
#ifndef Q3RT_LIB_REPORT_GLSL
#define Q3RT_LIB_REPORT_GLSL

// Expected SSIM (Wang et al. 2004) of a window between the truth and a mean with independent noise: the picture's
// variance there is the truth's plus the noise's, and the noise is in no way alike. Shown values in [0, 1].
float expectedLikeness(float pictureVariance, float noiseVariance)
{
    const float c2 = 0.0009f; // (0.03 x range)^2
    float truth = max(pictureVariance - noiseVariance, 0.0f);
    return (2.0f * truth + c2) / (2.0f * truth + noiseVariance + c2);
}

#endif
