// Points of a measured front: PRESET(name, ms, SSIM, settings), and the levels that rt_targetMs moves along,
// LEVEL(ms, SSIM, settings), each dearer and better than the one before. Made by q3rt trade --presets.
// oa_dm1, 2 views, 192x144, llvmpipe (LLVM 15.0.6, 256 bits), back end compute, renderer f38f8a33f92dfc85
// build/q3rt trade --map oa_dm1 --at spawn:0..1 --size 192x144 --warmup 8 --count 8 --reference-frames 256 --set rt_antialiasing=1 --axis rt_numRandomDL=1,2,4,0 --axis rt_denoiser=0,1 --axis rt_taa=0,1 --axis rt_scale=50,75,100 --axis rt_cullLights=2 --out front.jsonl --presets renderer_rt/presets.def.h
PRESET("fast", 10.877, 0.9890, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 0 rt_numRandomDL 1 rt_scale 50 rt_taa 1")
PRESET("balanced", 13.803, 0.9940, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 0 rt_numRandomDL 1 rt_scale 75 rt_taa 1")
PRESET("quality", 31.761, 0.9956, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 2 rt_scale 75 rt_taa 1")
PRESET("reference", 135.330, 0.9975, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 0 rt_scale 100 rt_taa 1")
LEVEL(15.510, 0.9910, "rt_numRandomDL 1 rt_scale 50")
LEVEL(31.761, 0.9956, "rt_numRandomDL 2 rt_scale 75")
LEVEL(73.817, 0.9973, "rt_numRandomDL 2 rt_scale 100")
