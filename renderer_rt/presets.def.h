// Points of a measured front: PRESET(name, ms, SSIM, settings), and the levels that rt_targetMs moves along,
// LEVEL(ms, SSIM, settings), each dearer and better than the one before. Made by q3rt trade --presets.
// oa_dm1, 2 views, 160x120, llvmpipe (LLVM 15.0.6, 256 bits), back end compute, renderer ace38b58e72598a2
// build/q3rt trade --map oa_dm1 --at spawn:0..1 --size 160x120 --warmup 8 --count 6 --reference-frames 256 --set rt_antialiasing=1 --axis rt_numRandomDL=1,2,4,0 --axis rt_denoiser=0,1 --axis rt_taa=0,1 --axis rt_scale=50,60,70,80,90,100 --axis rt_cullLights=2 --out front.jsonl --presets renderer_rt/presets.def.h
PRESET("fast", 6.380, 0.9508, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 1 rt_scale 50 rt_taa 0")
PRESET("balanced", 18.002, 0.9843, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 1 rt_scale 100 rt_taa 1")
PRESET("quality", 50.942, 0.9887, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 1 rt_numRandomDL 4 rt_scale 100 rt_taa 1")
PRESET("reference", 177.055, 0.9951, "rt_antialiasing 1 rt_cullLights 2 rt_denoiser 0 rt_numRandomDL 0 rt_scale 100 rt_taa 1")
LEVEL(8.402, 0.9706, "rt_numRandomDL 1 rt_scale 50")
LEVEL(13.133, 0.9741, "rt_numRandomDL 4 rt_scale 50")
LEVEL(13.856, 0.9742, "rt_numRandomDL 1 rt_scale 60")
LEVEL(16.564, 0.9837, "rt_numRandomDL 1 rt_scale 90")
LEVEL(18.002, 0.9843, "rt_numRandomDL 1 rt_scale 100")
LEVEL(21.560, 0.9857, "rt_numRandomDL 2 rt_scale 90")
LEVEL(41.776, 0.9863, "rt_numRandomDL 2 rt_scale 100")
LEVEL(41.890, 0.9877, "rt_numRandomDL 4 rt_scale 90")
LEVEL(50.942, 0.9887, "rt_numRandomDL 4 rt_scale 100")
